// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ipc/base/clock.hpp"
#include "ipc/msg/rung.hpp"
#include "supervisor/look/top/units_text.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr std::int64_t kSilentTooLong_ns = 1'000'000'000;  ///< for a ring without a regular rate

std::string text_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

double number_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}

/// The same, limited to what can be converted to nanoseconds or to an int.
double small_number_in(const json& object, const char* key) {
  return std::clamp(number_in(object, key), 0.0, 1e9);
}

/// Counts per second; empty if the count decreased, because another process counts now.
std::optional<double> rate(std::uint64_t before, std::uint64_t now, std::int64_t span_ns) {
  if (now < before || span_ns <= 0) return std::nullopt;
  return static_cast<double>(now - before) / ns_to_seconds(span_ns);
}

/// E.g. "died 10 times within 60 s; again in 2.1 s: last line of its log".
std::string trouble_in(const json& service) {
  auto trouble = text_in(service, "reason");
  if (const auto wait_s = small_number_in(service, "retry_s"); wait_s > 0)
    trouble += fmt::format("{}again in {}", trouble.empty() ? "" : "; ",
                           text_of_span(seconds_to_ns(wait_s)));
  const auto log = service.find("log");
  if (log == service.end() || !log->is_array() || log->empty() || !log->back().is_string())
    return trouble;
  auto last_line = log->back().get<std::string>();
  if (trouble.empty() || last_line.ends_with(trouble)) return last_line;
  return trouble + ": " + last_line;
}

const ProcessUsage* usage_in(const RigLook& look, pid_t pid) {
  const auto found = look.processes.find(pid);
  return found == look.processes.end() ? nullptr : &found->second;
}

ServiceRow service_row(const std::string& name, const json& service, const RigLook& before,
                       const RigLook& now) {
  ServiceRow row{.name = name,
                 .state = text_in(service, "state"),
                 .backend = text_in(service, "backend"),
                 .last_exit = text_in(service, "last_exit"),
                 .trouble = trouble_in(service),
                 .pid = pid_in(service, "pid"),
                 .spare_pid = pid_in(service, "standby"),
                 .restarts = static_cast<int>(small_number_in(service, "restarts")),
                 .uptime_s = small_number_in(service, "uptime_s")};
  const auto* usage = usage_in(now, row.pid);
  const auto* earlier = usage_in(before, row.pid);
  if (usage) row.usage = *usage;
  if (!usage && row.pid > 0 && !now.missing.empty())
    row.state = "gone";  // the last status of the supervisor is outdated
  if (usage && earlier) row.cores = cores_used(*earlier, *usage);
  return row;
}

/// The names of the processes of a rig: names of services, otherwise program names.
class Names {
 public:
  explicit Names(const RigLook& look) : look_(look) {
    if (!look.status.contains("services")) return;
    for (const auto& [name, service] : look.status["services"].items()) {
      services_[pid_in(service, "pid")] = name;
      services_[pid_in(service, "standby")] = name + " (spare)";
    }
  }
  std::string of(pid_t pid) const {
    if (const auto found = services_.find(pid); found != services_.end()) return found->second;
    const auto* usage = usage_in(look_, pid);
    if (!usage) return "?";
    return usage->program == "handcast" ? "supervisor" : usage->program;
  }

 private:
  const RigLook& look_;
  std::map<pid_t, std::string> services_;
};

template <class Things, class Same>
auto find_same(const Things& things, Same same) {
  const auto found = std::ranges::find_if(things, same);
  return found == std::end(things) ? nullptr : &*found;
}

ReaderRow reader_row(const ipc::ReaderView& reader, const ipc::RingSnapshot* earlier,
                     std::int64_t span_ns, const RigLook& look, const Names& names) {
  ReaderRow row{
      .now = reader, .who = names.of(reader.pid), .gone = usage_in(look, reader.pid) == nullptr};
  if (!earlier) return row;
  const auto same = [&](const auto& other) {
    return other.row == reader.row && other.pid == reader.pid;
  };
  if (const auto* before = find_same(earlier->readers, same)) {
    row.received_hz = rate(before->received, reader.received, span_ns);
    row.skipped_hz = rate(before->skipped, reader.skipped, span_ns);
  }
  return row;
}

std::optional<double> wanted_hz_of(const std::string& stream, const json& status) {
  if (!status.contains("rings") || !status["rings"].contains(stream)) return std::nullopt;
  const auto wanted_hz = number_in(status["rings"][stream], "wanted_hz");
  return wanted_hz > 0 ? std::optional(wanted_hz) : std::nullopt;
}

RingRow ring_row(const ipc::RingSnapshot& ring, const RigLook& before, const RigLook& now,
                 const Names& names) {
  RingRow row{.now = ring, .wanted_hz = wanted_hz_of(ring.stream, now.status)};
  if (ring.newest_published_ns != 0) {
    row.newest_age_ns = std::max<std::int64_t>(0, now.taken_ns - ring.newest_published_ns);
    row.latency_ns = ring.newest_published_ns - ring.newest_origin_ns;
  }
  const auto span_ns = now.taken_ns - before.taken_ns;
  const auto* earlier =
      find_same(before.rings, [&](const auto& other) { return other.stream == ring.stream; });
  if (earlier) {
    row.rate_hz = rate(earlier->published, ring.published, span_ns);
    row.dropped_hz = rate(earlier->dropped, ring.dropped, span_ns);
  }
  for (const auto& reader : ring.readers)
    row.readers.push_back(reader_row(reader, earlier, span_ns, now, names));
  return row;
}

std::vector<RungShare> rungs_of(const RigLook& before, const RigLook& now) {
  if (!now.status.contains("rungs")) return {};
  const auto hands_in = [](const RigLook& look, const std::string& rung) {
    return look.status.contains("rungs") ? number_in(look.status["rungs"], rung.c_str()) : 0.0;
  };
  std::vector<RungShare> rungs;
  double all = 0;
  for (const auto rung : msg::kRungNames) {
    const std::string name(rung);
    const double hands = hands_in(now, name) - hands_in(before, name);
    if (hands <= 0) continue;
    rungs.push_back({name, hands});
    all += hands;
  }
  for (auto& rung : rungs) rung.share /= all;
  return rungs;
}

std::vector<ReasonCount> losses_of(const RigLook& before, const RigLook& now) {
  if (!now.status.contains("lost_images") || !before.status.contains("lost_images")) return {};
  std::vector<ReasonCount> losses;
  for (const auto& [reason, count] : now.status["lost_images"].items()) {
    const double lost = number_in(now.status["lost_images"], reason.c_str()) -
                        number_in(before.status["lost_images"], reason.c_str());
    if (lost > 0) losses.push_back({reason, lost});
  }
  return losses;
}

}  // namespace

bool ReaderRow::holds_an_old_lease() const {
  return std::ranges::any_of(now.lease_ages_ns, [](auto age_ns) { return age_ns > kOldLease_ns; });
}

bool RingRow::late() const {
  if (!newest_age_ns) return false;
  const auto hz = marks() ? 0 : std::max(wanted_hz.value_or(0), rate_hz.value_or(0));
  return *newest_age_ns > (hz > 0 ? seconds_to_ns(kLatePeriods / hz) : kSilentTooLong_ns);
}

TopModel compare(const RigLook& before, const RigLook& now) {
  TopModel model{.rig = now.rig, .missing = now.missing};
  const Names names(now);
  if (now.status.is_object()) model.uptime_s = small_number_in(now.status, "uptime_s");
  if (now.status.contains("services"))
    for (const auto& [name, service] : now.status["services"].items())
      model.services.push_back(service_row(name, service, before, now));
  for (const auto& ring : now.rings) model.rings.push_back(ring_row(ring, before, now, names));
  model.rungs = rungs_of(before, now);
  model.lost_images = losses_of(before, now);
  return model;
}

}  // namespace handcast::supervisor
