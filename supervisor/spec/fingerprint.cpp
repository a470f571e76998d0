// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "config/settings/files.hpp"
#include "config/settings/settings.hpp"

namespace handcast::supervisor {
namespace {

using Paths =
    std::vector<std::string_view>;  ///< sections (with those inside them) and single settings

/// What a service depends on with one of its back ends.
struct Reads {
  std::string_view service;
  std::string_view backend;  ///< "": with each
  Paths paths;
};

/// The true person and motion (services/evaluation/twin/twin.cpp), without which Twin::create
/// fails.
const Paths kTruth{"twin.motion", "twin.hands", "twin.speed", "twin.seed", "twin.shape", "hand"};
const Paths kEveryDaemon{"calibration"};

const std::vector<Reads>& table() {
  static const std::vector<Reads> kTable{
      {"camera", "", {"camera.backend", "camera.rate_hz", "camera.exposure_ms", "camera.process"}},
      {"camera", "replay", {"camera.replay"}},
      {"camera", "twin", kTruth},
      {"camera", "twin", {"twin.image"}},
      {"pose", "", {"pose.backend", "pose.process"}},
      {"pose", "replay", {"pose.replay"}},
      {"pose", "twin", kTruth},
      {"pose", "twin", {"twin.tracker"}},
      {"landmarks", "", {"landmarks.backend", "landmarks.process"}},
      {"landmarks", "replay", {"landmarks.replay"}},
      {"landmarks", "handcast", {"landmarks.executor", "landmarks.models", "landmarks.hands"}},
      {"landmarks",
       "mediapipe",
       {"landmarks.executor", "landmarks.models", "landmarks.hands", "landmarks.definition"}},
      {"landmarks", "twin", kTruth},
      {"landmarks",
       "twin",
       {"twin.detector", "twin.image.delivery_ms", "camera.rate_hz", "camera.exposure_ms"}},
      {"projector", "", {"projector", "content", "hand", "cascade"}},
      {"observer", "", {"observer", "camera.backend", "pose.backend"}},
      {"observer", "", kTruth},
      {"exporter", "", {"supervisor.metrics_port"}},
  };
  return kTable;
}

/// Files that are small and may change under their names: their content counts, too.
const Paths kFiles{"calibration", "hand.left", "hand.right", "content.left", "content.right"};

/// What only the supervisor reads.
bool is_the_supervisors(std::string_view service, std::string_view path) {
  return path == "name" || path == fmt::format("{}.process.standby", service) ||
         path == fmt::format("{}.enabled", service);
}

bool is_within(std::string_view path, std::string_view section) {
  return path == section ||
         (path.starts_with(section) && path.substr(section.size()).starts_with('.'));
}

bool is_in(std::string_view path, const Paths& paths) {
  return std::ranges::any_of(paths, [&](auto section) { return is_within(path, section); });
}

/// A service or back end that is not in the table depends on everything: it is restarted too often
/// rather than too seldom.
bool reads(std::string_view service, std::string_view backend, std::string_view path) {
  bool has_backends = false, knows_backend = false, found = is_in(path, kEveryDaemon),
       knows_service = false;
  for (const auto& line : table()) {
    if (line.service != service) continue;
    knows_service = true;
    has_backends = has_backends || !line.backend.empty();
    if (!line.backend.empty() && line.backend != backend) continue;
    knows_backend = knows_backend || !line.backend.empty();
    found = found || is_in(path, line.paths);
  }
  if (!knows_service || (has_backends && !knows_backend)) return !is_within(path, "supervisor");
  return found;
}

/// FNV-1a over a sequence of texts, each with its end.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) add(c);
    add('\0');
  }
  std::string print() const { return fmt::format("{:016x}", value_); }

 private:
  void add(char c) { value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211ull; }
  std::uint64_t value_ = 14695981039346656037ull;
};

std::string content_of(const config::Setting& setting) {
  const auto& file = *std::get<std::string*>(setting.target);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  return config::read_text(file).value_or("");
}

/// Null for a service without back ends.
std::string* backend_in(std::string_view service, const config::Listing& listing) {
  const auto* backend = config::find_setting(listing, fmt::format("{}.backend", service));
  return backend ? std::get<std::string*>(backend->target) : nullptr;
}

}  // namespace

std::string fingerprint_of(std::string_view service, const config::Rig& rig) {
  auto copy = rig;  // a listing refers to values that can be written
  const auto listing = config::list_settings(copy);
  const auto backend = backend_of(service, rig);
  Hash hash;
  for (const auto& section : listing) {
    for (const auto& setting : section.settings) {
      if (is_the_supervisors(service, setting.path) || !reads(service, backend, setting.path))
        continue;
      hash.add(setting.path);
      hash.add(config::print_value(setting));
      if (is_in(setting.path, kFiles)) hash.add(content_of(setting));
    }
  }
  return hash.print();
}

std::string backend_of(std::string_view service, const config::Rig& rig) {
  auto copy = rig;
  const auto* backend = backend_in(service, config::list_settings(copy));
  return backend ? *backend : std::string();
}

config::Rig with_backend(config::Rig rig, std::string_view service, const std::string& backend) {
  if (auto* asked = backend_in(service, config::list_settings(rig))) *asked = backend;
  return rig;
}

}  // namespace handcast::supervisor
