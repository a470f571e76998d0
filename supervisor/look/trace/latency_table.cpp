// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/latency_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "ipc/base/clock.hpp"
#include "supervisor/look/trace/made_frames.hpp"
#include "supervisor/record/ledger.hpp"

namespace handcast::supervisor {
namespace {

using msg::Stage;

/// Collects the spans between pairs of events, in the order in which the pairs are first added,
/// those of a second camera or projector last.
class Ways {
 public:
  void add(const std::string& from, const std::string& to, std::optional<std::int64_t> span_ns) {
    const auto same = [&](const Way& way) { return way.from == from && way.to == to; };
    auto found = std::ranges::find_if(ways_, same);
    if (found == ways_.end()) found = ways_.insert(ways_.end(), {from, to, {}});
    if (span_ns && *span_ns >= 0) found->spans_ns.push_back(*span_ns);
  }
  std::vector<WayLatency> take() {
    const auto is_of_first = [](const Way& way) { return !way.to.ends_with('2'); };
    std::stable_partition(ways_.begin(), ways_.end(), is_of_first);
    std::vector<WayLatency> latencies;
    for (auto& way : ways_) latencies.push_back({way.from, way.to, Spans(std::move(way.spans_ns))});
    return latencies;
  }

 private:
  struct Way {
    std::string from, to;
    std::vector<std::int64_t> spans_ns;
  };
  std::vector<Way> ways_;
};

std::vector<StageLatency> stage_latencies(const HistorySnapshot& history) {
  constexpr auto kStages = msg::kStageNames.size();
  std::vector<std::array<std::vector<std::int64_t>, kStages>> spans_ns(history.services.size());
  for (const auto& frame : history.frames)
    for (const auto& mark : frame.marks)
      spans_ns[frame.service][static_cast<std::size_t>(mark.stage)].push_back(mark.end_ns -
                                                                              mark.begin_ns);

  std::vector<StageLatency> stages;
  for (std::size_t service = 0; service < spans_ns.size(); ++service)
    for (std::size_t stage = 0; stage < kStages; ++stage)
      if (!spans_ns[service][stage].empty())
        stages.push_back({history.services[service], std::string(msg::kStageNames[stage]),
                          Spans(std::move(spans_ns[service][stage]))});
  return stages;
}

std::vector<WayLatency> way_latencies(const HistorySnapshot& history) {
  Ways ways;
  const auto named = [&](const char* event, const FrameRecord& frame) {
    return name_at_instance(event, history.services[frame.service]);
  };
  for (const auto& frame : history.frames)
    if (const auto* capture = find_mark(frame, Stage::capture))
      ways.add(named("exposure", frame), named("image delivered", frame),
               age_of(frame.header.origin_ns, *capture));
  for (const auto& frame : history.frames)
    if (const auto* detect = find_mark(frame, Stage::detect))
      ways.add(named("exposure", frame), named("landmarks found", frame),
               age_of(frame.header.origin_ns, *detect));

  std::set<std::size_t> shown;
  for (const auto& made : made_frames(history)) {
    const auto& frame = history.frames[made.frame];
    const auto* begun = find_mark(frame, Stage::frame);
    const auto* light = find_light(frame);
    if (!light) continue;
    const msg::StageMark begin{Stage::frame, 0, begun->begin_ns, begun->begin_ns};
    const auto lit = named("light", frame);
    ways.add("exposure", named("frame begun", frame), age_of(frame.made_from.image_ns, begin));
    ways.add("exposure", lit, age_of(frame.made_from.image_ns, *light));
    ways.add("landmarks' exposure", lit, age_of(frame.made_from.landmarks_ns, *light));
    ways.add("pose sample", lit, age_of(frame.made_from.pose_ns, *light));
    if (!made.image || !shown.insert(*made.image).second) continue;
    ways.add("image delivered", "first light",
             light->end_ns - find_mark(history.frames[*made.image], Stage::capture)->end_ns);
  }
  return ways.take();
}

/// A frame that a service has finished.
struct Done {
  std::int64_t time_ns = 0;  ///< the end of its last mark
  std::uint64_t frame_id = 0;
  std::uint64_t lost = 0;  ///< frames finished before this one whose marks were lost
  bool from_sensor = false;
};

std::vector<Done> done_by(const HistorySnapshot& history, std::size_t service) {
  std::vector<Done> done;
  for (const auto& frame : history.frames) {
    if (frame.service != service || frame.marks.empty()) continue;
    const auto last = std::ranges::max(frame.marks, {}, &msg::StageMark::end_ns);
    const bool from_sensor = find_mark(frame, Stage::capture) || find_mark(frame, Stage::sample);
    done.push_back({last.end_ns, frame.header.frame_id, frame.missed, from_sensor});
  }
  std::ranges::stable_sort(done, {}, &Done::time_ns);
  return done;
}

std::uint64_t above(std::uint64_t value, std::uint64_t allowed) {
  return value > allowed ? value - allowed : 0;
}

/// The time between two frames in periods.
double periods_between(const Done& before, const Done& after, double hz) {
  return ns_to_seconds(after.time_ns - before.time_ns) * hz;
}

/// The number of periods without a frame before frame `i`. If frame `i` is late but the next one is
/// in time again, no period was missed.
std::uint64_t missed_before(const std::vector<Done>& done, std::size_t i, double hz) {
  auto periods = periods_between(done[i - 1], done[i], hz);
  std::uint64_t frames = 1 + done[i].lost;
  if (periods <= 0.5 + static_cast<double>(frames)) return 0;
  const bool caught_up =
      i + 1 < done.size() && done[i + 1].lost == 0 && periods_between(done[i], done[i + 1], hz) < 1;
  if (caught_up) periods += periods_between(done[i], done[i + 1], hz), ++frames;
  return above(static_cast<std::uint64_t>(std::llround(periods)), frames);
}

void count_gap(const std::vector<Done>& done, std::size_t i, Misses& misses) {
  const auto &before = done[i - 1], &after = done[i];
  misses.lost_marks += after.lost;
  if (after.from_sensor && after.frame_id > before.frame_id)
    misses.skipped_ids += above(after.frame_id - before.frame_id - 1, after.lost);
  if (misses.wanted_hz > 0) misses.missed += missed_before(done, i, misses.wanted_hz);
  if (after.lost > 0) return;
  misses.longest_gap_ns = std::max(misses.longest_gap_ns, after.time_ns - before.time_ns);
  if (periods_between(before, after, misses.wanted_hz) > 1.5) ++misses.late;
}

Misses misses_of(const HistorySnapshot& history, std::size_t service, double wanted_hz) {
  const auto done = done_by(history, service);
  Misses misses{
      .service = history.services[service], .frames = done.size(), .wanted_hz = wanted_hz};
  for (std::size_t i = 1; i < done.size(); ++i) count_gap(done, i, misses);
  const auto span_ns = done.empty() ? 0 : done.back().time_ns - done.front().time_ns;
  if (span_ns > 0)
    misses.held_hz =
        static_cast<double>(done.size() - 1 + misses.lost_marks) / ns_to_seconds(span_ns);
  return misses;
}

std::map<std::string, LightCount> lights_of(const HistorySnapshot& history) {
  std::map<std::string, LightCount> lights;
  for (const auto& frame : history.frames)
    if (const auto* mark = find_mark(frame, Stage::light))
      if (const auto note = msg::light_note_in(mark->detail))
        lights[history.services[frame.service]].add(*note);
  return lights;
}

double seconds_in(const HistorySnapshot& history) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max(), last_ns = 0;
  for (const auto& frame : history.frames) {
    for (const auto& mark : frame.marks) {
      first_ns = std::min(first_ns, mark.end_ns);
      last_ns = std::max(last_ns, mark.end_ns);
    }
  }
  return last_ns > first_ns ? ns_to_seconds(last_ns - first_ns) : 0;
}

}  // namespace

Spans::Spans(std::vector<std::int64_t> spans_ns) : sorted_ns_(std::move(spans_ns)) {
  std::ranges::sort(sorted_ns_);
}

std::int64_t Spans::percentile_ns(double share) const {
  if (sorted_ns_.empty()) return 0;
  const auto rank =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted_ns_.size())));
  return sorted_ns_[std::clamp<std::size_t>(rank, 1, sorted_ns_.size()) - 1];
}

LatencyTable measure_latency(const HistorySnapshot& history,
                             const std::map<std::string, double>& wanted_hz) {
  LatencyTable table{seconds_in(history),
                     stage_latencies(history),
                     way_latencies(history),
                     {},
                     lights_of(history)};
  for (std::size_t service = 0; service < history.services.size(); ++service) {
    const auto asked = wanted_hz.find(history.services[service]);
    auto misses = misses_of(history, service, asked == wanted_hz.end() ? 0 : asked->second);
    if (misses.frames > 0) table.misses.push_back(std::move(misses));
  }
  return table;
}

}  // namespace handcast::supervisor
