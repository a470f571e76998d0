// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include "ipc/base/inherited.hpp"
#include "ipc/base/join.hpp"

namespace handcast::doctor {
namespace fs = std::filesystem;
namespace {

constexpr unsigned kCores = 4;            ///< camera, tracker, detector and projector
constexpr double kLeastDisk_GB = 5;       ///< five minutes of `handcast record`
constexpr long kSocketBytes = 3'000'000;  ///< eight images of 720 x 540
constexpr int kJumbo_bytes = 8000;

std::optional<std::string> first_word(const fs::path& file) {
  std::ifstream stream(file);
  std::string word;
  if (!(stream >> word)) return std::nullopt;
  return word;
}

std::optional<long> number_in(const fs::path& file) {
  const auto word = first_word(file);
  if (!word) return std::nullopt;
  char* end = nullptr;
  const long number = std::strtol(word->c_str(), &end, 10);
  if (*end != '\0') return std::nullopt;
  return number;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder, error)) entries.push_back(entry.path());
  std::ranges::sort(entries);
  return entries;
}

Finding cores() {
  const unsigned count = std::max(std::thread::hardware_concurrency(), 1u);
  if (count >= kCores) return {"cores", Grade::good, fmt::format("{} cores", count), ""};
  return {
      "cores", Grade::advice,
      fmt::format("this computer has {} processor cores; camera, tracker, detector and projector "
                  "work best with one each, which makes {}",
                  count, kCores),
      "if `handcast status` shows rates that are not held, lower projector.rate_hz and "
      "camera.rate_hz"};
}

Finding governor(const fs::path& root) {
  std::set<std::string> slow;
  bool is_scaled = false;
  for (const auto& cpu : entries_of(root / "sys/devices/system/cpu"))
    if (const auto word = first_word(cpu / "cpufreq/scaling_governor")) {
      is_scaled = true;
      if (*word != "performance") slow.insert(*word);
    }
  if (!is_scaled)
    return {"cpu governor", Grade::good, "the kernel does not change the processor's speed", ""};
  if (slow.empty()) return {"cpu governor", Grade::good, "performance", ""};
  return {"cpu governor", Grade::advice,
          fmt::format("'{}': the processor is slow after each pause", join(slow, "', '")),
          "sudo cpupower frequency-set -g performance"};
}

Finding socket_buffers(const fs::path& root) {
  const auto bytes = number_in(root / "proc/sys/net/core/rmem_max");
  if (!bytes)
    return {"socket buffers", Grade::advice, "their size cannot be read",
            "cat /proc/sys/net/core/rmem_max; 8000000 is enough"};
  if (*bytes >= kSocketBytes)
    return {"socket buffers", Grade::good, fmt::format("{} bytes", *bytes), ""};
  return {
      "socket buffers", Grade::advice,
      fmt::format("{} bytes: packets of a GigE camera are lost while the computer is busy", *bytes),
      "sudo sysctl -w net.core.rmem_max=8000000"};
}

Finding packet_size(const fs::path& root) {
  std::vector<std::string> small;
  for (const auto& link : entries_of(root / "sys/class/net")) {
    const auto bytes = number_in(link / "mtu");
    if (!bytes || link.filename() == "lo") continue;
    if (*bytes >= kJumbo_bytes)
      return {"packet size", Grade::good,
              fmt::format("{} has packets of {} bytes", link.filename().string(), *bytes), ""};
    small.push_back(link.filename().string());
  }
  if (small.empty())
    return {"packet size", Grade::good, "no network; only a USB3 camera can be attached", ""};
  return {"packet size", Grade::advice,
          fmt::format("{}: small packets; a GigE camera costs more processor time and loses more",
                      join(small, ", ")),
          fmt::format("sudo ip link set {} mtu 9000, on the camera's link", small.front())};
}

Finding udev_rules(const fs::path& root) {
  std::error_code error;
  for (const auto* folder : {"etc/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d"})
    if (fs::exists(root / folder / "70-handcast.rules", error))
      return {"udev rules", Grade::good, "installed", ""};
  return {"udev rules", Grade::advice, "USB devices may be closed to users",
          "scripts/setup --udev"};
}

Finding disk() {
  std::error_code error;
  const auto space = fs::space(fs::current_path(error), error);
  const double free_GB = error ? 0 : 1e-9 * static_cast<double>(space.available);
  if (free_GB >= kLeastDisk_GB)
    return {"disk", Grade::good, fmt::format("{:.0f} GB are free here", free_GB), ""};
  return {"disk", Grade::advice, fmt::format("only {:.1f} GB are free here", free_GB),
          "free some before `handcast record` or projector.file"};
}

}  // namespace

std::vector<Finding> examine_machine(const config::Rig& rig, const fs::path& root) {
  std::vector<Finding> findings{cores(), governor(root), disk()};
  for (const auto& obstacle : inherited::obstacles())
    findings.push_back({"limits", Grade::advice, obstacle,
                        "start handcast from a shell or a unit without this limit"});
  const bool has_aravis = rig.camera.backend == "aravis";
  if (has_aravis) {
    findings.push_back(socket_buffers(root));
    findings.push_back(packet_size(root));
  }
  if (has_aravis || rig.camera.backend == "leap" || rig.dlp.backend != "none")
    findings.push_back(udev_rules(root));
  return findings;
}

}  // namespace handcast::doctor
