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

constexpr std::int64_t kSilentTooLong_ns = 1'000'000'000;  ///< for a ring without a regular rate

/// Counts per second; empty if the count decreased, because another process counts now.
std::optional<double> rate(std::uint64_t before, std::uint64_t now, std::int64_t span_ns) {
  if (now < before || span_ns <= 0) return std::nullopt;
  return static_cast<double>(now - before) / ns_to_seconds(span_ns);
}

/// E.g. "died 10 times within 60 s; again in 2.1 s: last line of its log".
std::string trouble_of(const ServiceFigures& service) {
  auto trouble = service.reason;
  if (service.retry_s.value_or(0) > 0)
    trouble += fmt::format("{}again in {}", trouble.empty() ? "" : "; ",
                           text_of_span(seconds_to_ns(*service.retry_s)));
  if (service.log.empty()) return trouble;
  const auto& last_line = service.log.back();
  if (trouble.empty() || last_line.ends_with(trouble)) return last_line;
  return trouble + ": " + last_line;
}

const ProcessUsage* usage_in(const RigLook& look, pid_t pid) {
  const auto found = look.processes.find(pid);
  return found == look.processes.end() ? nullptr : &found->second;
}

ServiceRow service_row(const std::string& name, const ServiceFigures& service,
                       const RigLook& before, const RigLook& now) {
  ServiceRow row{service, name, trouble_of(service), std::nullopt, std::nullopt};
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
    if (!look.figures) return;
    for (const auto& [name, service] : look.figures->services) {
      services_[service.pid] = name;
      services_[service.standby_pid] = name + " (standby)";
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

std::optional<double> wanted_hz_of(const std::string& stream, const RigLook& look) {
  if (!look.figures) return std::nullopt;
  const auto found = look.figures->streams.find(stream);
  return found == look.figures->streams.end() ? std::nullopt : found->second.wanted_hz;
}

RingRow ring_row(const ipc::RingSnapshot& ring, const RigLook& before, const RigLook& now,
                 const Names& names) {
  RingRow row{.now = ring, .wanted_hz = wanted_hz_of(ring.stream, now)};
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

/// By how much a count has grown between two looks; negative after a new start.
double growth(const std::map<std::string, std::uint64_t>& before, const std::string& key,
              std::uint64_t now) {
  const auto found = before.find(key);
  return static_cast<double>(now) -
         (found == before.end() ? 0.0 : static_cast<double>(found->second));
}

std::vector<RungShare> rungs_of(const Figures& before, const Figures& now) {
  std::vector<RungShare> rungs;
  double all = 0;
  for (const auto rung : msg::kRungNames) {
    const auto found = now.rungs.find(std::string(rung));
    if (found == now.rungs.end()) continue;
    const double hands = growth(before.rungs, found->first, found->second);
    if (hands <= 0) continue;
    rungs.push_back({found->first, hands});
    all += hands;
  }
  for (auto& rung : rungs) rung.share /= all;
  return rungs;
}

std::vector<ReasonCount> losses_of(const Figures& before, const Figures& now) {
  std::vector<ReasonCount> losses;
  for (const auto& [reason, count] : now.lost_images)
    if (const double lost = growth(before.lost_images, reason, count); lost > 0)
      losses.push_back({reason, lost});
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
  for (const auto& ring : now.rings) model.rings.push_back(ring_row(ring, before, now, names));
  if (!now.figures) return model;
  model.uptime_s = now.figures->uptime_s;
  for (const auto& [name, service] : now.figures->services)
    model.services.push_back(service_row(name, service, before, now));
  model.rungs = rungs_of(before.figures.value_or(Figures()), *now.figures);
  if (before.figures) model.lost_images = losses_of(*before.figures, *now.figures);
  return model;
}

}  // namespace handcast::supervisor
