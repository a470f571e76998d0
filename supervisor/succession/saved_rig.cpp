// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/saved_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr int kVersion = 3;  ///< incremented when the meaning of a member changes
constexpr int kLeastFd = 3, kMostFd = 1 << 20;  ///< lower numbers: stdin, stdout, stderr
constexpr pid_t kLeastPid = 2, kMostPid = 1 << 22;

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
          {"restarts", service.restarts},
          {"log_inode", service.log_inode}};
}

json to_json(const SavedRig& rig) {
  json object{
      {"version", kVersion},      {"name", rig.name},       {"rig_file", rig.rig_file.string()},
      {"settings", rig.settings}, {"out", rig.out},         {"applied", rig.applied},
      {"epoch_ns", rig.epoch_ns}, {"rings", json::array()}, {"services", json::array()}};
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
          .restarts = object.at("restarts"),
          .log_inode = object.value("log_inode", std::uint64_t{0})};
}

/// Throws json::exception if a member is missing or of another type.
SavedRig rig_from(const json& object) {
  SavedRig rig{.name = object.at("name"),
               .rig_file = object.at("rig_file").get<std::string>(),
               .settings = object.at("settings"),
               .out = object.at("out"),
               .applied = object.at("applied"),
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

}  // namespace

std::string print_saved(const SavedRig& rig) {
  return to_json(rig).dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<SavedRig> parse_saved(const std::string& text, const std::string& name) {
  const auto invalid = [&](std::string_view why) {
    return fail(Errc::bad_data,
                fmt::format("the saved state of rig '{}' is invalid: {}", name, why));
  };
  const auto object = json::parse(text, nullptr, false);
  if (!object.is_object()) return invalid("it is incomplete");
  try {
    if (object.at("version") != kVersion) return invalid("another version of handcast wrote it");
    auto rig = rig_from(object);
    if (const auto problem = problem_of(rig, name); !problem.empty()) return invalid(problem);
    return rig;
  } catch (const json::exception& error) {
    return invalid(shown_line(error.what(), 200));
  }
}

}  // namespace handcast::supervisor
