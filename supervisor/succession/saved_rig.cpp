// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/saved_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "ipc/base/unique_fd.hpp"
#include "ipc/control/runtime_folder.hpp"
#include "supervisor/base/replace_file.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr int kVersion = 2;                  ///< incremented when the meaning of a member changes
constexpr std::size_t kMostBytes = 1 << 20;  ///< a rig needs about 3 KB
constexpr int kLeastFd = 3, kMostFd = 1 << 20;  ///< lower numbers: stdin, stdout, stderr
constexpr pid_t kLeastPid = 2, kMostPid = 1 << 22;

Result<std::filesystem::path> state_of(const std::string& rig) {
  auto path = control::socket_of(rig);
  if (path) path->replace_extension(".state");
  return path;
}

std::string text_of(int fd, std::size_t most_bytes) {
  std::string text;
  std::array<char, 4096> bytes;
  for (ssize_t count = 0;
       text.size() < most_bytes && (count = ::read(fd, bytes.data(), bytes.size())) > 0;)
    text.append(bytes.data(), static_cast<std::size_t>(count));
  return text;
}

std::string text_of_proc(const std::string& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return fd ? text_of(fd.get(), kMostBytes) : "";
}

std::string boot_id() { return text_of_proc("/proc/sys/kernel/random/boot_id").substr(0, 36); }

json to_json(const SavedRing& ring) {
  return {{"stream", ring.stream}, {"inode", ring.inode}, {"fd", ring.fd}};
}

json to_json(const SavedService& service) {
  return {{"name", service.name},
          {"pid", service.pid},
          {"started_ticks", service.started_ticks},
          {"state", name_of(service.state)},
          {"swapped", service.swapped},
          {"fingerprint", service.fingerprint},
          {"restarts", service.restarts}};
}

json to_json(const SavedRig& rig) {
  json object{{"version", kVersion},      {"boot", boot_id()},
              {"name", rig.name},         {"rig_file", rig.rig_file.string()},
              {"settings", rig.settings}, {"out", rig.out},
              {"epoch_ns", rig.epoch_ns}, {"rings", json::array()},
              {"services", json::array()}};
  for (const auto& ring : rig.rings) object["rings"].push_back(to_json(ring));
  for (const auto& service : rig.services) object["services"].push_back(to_json(service));
  return object;
}

SavedRing ring_from(const json& object) {
  return {object.at("stream"), object.at("inode"), object.at("fd")};
}

/// An unknown name counts as starting.
State state_named(const std::string& name) {
  const auto found = std::ranges::find(kStateNames, name);
  return found == kStateNames.end() ? State::starting
                                    : static_cast<State>(found - kStateNames.begin());
}

SavedService service_from(const json& object) {
  return {.name = object.at("name"),
          .pid = object.at("pid"),
          .started_ticks = object.at("started_ticks"),
          .state = state_named(object.at("state")),
          .swapped = object.at("swapped"),
          .fingerprint = object.at("fingerprint"),
          .restarts = object.at("restarts")};
}

/// Throws json::exception if a member is missing or of another type.
SavedRig rig_from(const json& object) {
  SavedRig rig{.name = object.at("name"),
               .rig_file = object.at("rig_file").get<std::string>(),
               .settings = object.at("settings"),
               .out = object.at("out"),
               .epoch_ns = object.at("epoch_ns"),
               .rings = {},
               .services = {}};
  for (const auto& ring : object.at("rings")) rig.rings.push_back(ring_from(ring));
  for (const auto& service : object.at("services")) rig.services.push_back(service_from(service));
  return rig;
}

/// Why the saved numbers of processes and descriptors must not be used; "" if they are valid.
std::string problem_of(const SavedRig& rig, const std::string& name) {
  if (rig.name != name) return fmt::format("it belongs to a rig named '{}'", rig.name);
  for (const auto& ring : rig.rings)
    if (ring.fd < kLeastFd || ring.fd > kMostFd)
      return fmt::format("ring '{}' has the descriptor {}", ring.stream, ring.fd);
  for (const auto& service : rig.services)
    if (service.pid != 0 && (service.pid < kLeastPid || service.pid > kMostPid))
      return fmt::format("{} has the pid {}", service.name, service.pid);
  return "";
}

/// Why another user could have written the file; "" if it has the owner and the mode of save().
std::string problem_of(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "it is not a file";
  if (status.st_uid != getuid()) return "it belongs to another user";
  if ((status.st_mode & 077) != 0) return "other users have access to it";
  if (static_cast<std::size_t>(status.st_size) > kMostBytes) return "it is too long";
  return "";
}

}  // namespace

Result<void> save(const SavedRig& rig) {
  const auto path = state_of(rig.name);
  if (!path) return tl::make_unexpected(path.error());
  return replace_file(*path,
                      to_json(rig).dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

Result<std::optional<SavedRig>> load_saved(const std::string& name) {
  const auto path = state_of(name);
  if (!path) return tl::make_unexpected(path.error());
  const auto invalid = [&](std::string_view why) {
    return fail(Errc::bad_data, fmt::format("{} is invalid: {}", path->string(), why));
  };

  const UniqueFd file(::open(path->c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file)
    return errno == ENOENT ? Result<std::optional<SavedRig>>(std::nullopt)
                           : invalid(std::strerror(errno));
  if (const auto problem = problem_of(file.get()); !problem.empty()) return invalid(problem);
  const auto object = json::parse(text_of(file.get(), kMostBytes), nullptr, false);
  if (!object.is_object()) return invalid("it is incomplete");
  try {
    if (object.at("boot") != boot_id()) return std::nullopt;
    if (object.at("version") != kVersion) return invalid("another version of handcast wrote it");
    auto rig = rig_from(object);
    if (const auto problem = problem_of(rig, name); !problem.empty()) return invalid(problem);
    return rig;
  } catch (const json::exception& error) {
    return invalid(error.what());
  }
}

void forget_saved(const std::string& rig) {
  if (const auto path = state_of(rig)) unlink(path->c_str());
}

}  // namespace handcast::supervisor
