// SPDX-License-Identifier: Apache-2.0
#include "services/watch/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "ipc/base/clock.hpp"
#include "ipc/msg/light_source.hpp"

namespace handcast::watch {
namespace {

constexpr double kVisitEnds_s = 5;    ///< hands that are away for longer come anew
constexpr double kNoGap_s = 0.25;     ///< between two samples of one hand
constexpr double kLongestStep_s = 5;  ///< the computer slept for the rest
constexpr float kSeen = 0.1F;         ///< as msg::HandPose::confidence

bool has_hands(const msg::HandPoses& poses) {
  const auto hands = std::span(poses.hands).first(std::min<std::size_t>(poses.count, 2));
  return std::ranges::any_of(hands, [](const auto& hand) { return hand.confidence >= kSeen; });
}

}  // namespace

Tally::Tally(Day& day, std::int64_t rig_started_ns, std::int64_t now_ns, std::time_t time)
    : day_(day), rig_is_new_(day.rig_started_ns != rig_started_ns), passed_ns_(now_ns) {
  constexpr std::int64_t kDay_s = 24 * 60 * 60;
  if (!rig_is_new_ && day.counted_until > 0)
    day.up_s += static_cast<double>(std::clamp<std::int64_t>(time - day.counted_until, 0, kDay_s));
  if (rig_is_new_) {
    ++day.starts;
    day.rig_started_ns = rig_started_ns;
    day.counted.clear();
    day.lights.reset();
    day.note(time, "the rig was started");
  }
  day.counted_until = time;
}

void Tally::add(const msg::StageMarks& marks) {
  if (marks.count == 0) return;
  const auto from_ns =
      marks.made_from.image_ns > 0 ? marks.made_from.image_ns : marks.made_from.pose_ns;
  ++day_.frames;
  const auto count = std::min<std::size_t>(marks.count, marks.marks.size());
  for (const auto& mark : std::span(marks.marks).first(count)) {
    if (mark.stage != msg::Stage::light) continue;
    const auto note = msg::light_note_in(mark.detail);
    if (note && note->refreshes > 1) day_.missed_refreshes += note->refreshes - 1;
    if (from_ns > 0 && mark.end_ns > from_ns) day_.latencies.add(ns_to_ms(mark.end_ns - from_ns));
  }
}

void Tally::add(const msg::HandPoses& poses) {
  if (!has_hands(poses)) return;
  const auto away_s = ns_to_seconds(poses.header.origin_ns - hands_ns_);
  if (hands_ns_ == 0 || away_s > kVisitEnds_s) {
    ++day_.visits;
    visit_s_ = 0;
  } else if (away_s > 0) {
    day_.hands_s += std::min(away_s, kNoGap_s);
    visit_s_ += away_s;
    day_.longest_visit_s = std::max(day_.longest_visit_s, visit_s_);
  }
  hands_ns_ = poses.header.origin_ns;
}

void Tally::add(const RigStatus& status, std::time_t time) {
  for (const auto& [name, service] : status.services) {
    auto& counted = day_.counted[name];
    const int more = service.restarts - counted;
    counted = service.restarts;
    if (more <= 0) continue;  // an earlier supervisor had counted
    const auto why = service.reason.empty() ? "unknown" : service.reason;
    day_.restarts[name][why] += more;
    day_.note(time, fmt::format("{} was started again: {}", name, why));
  }
  if (status.drift) day_.drift = status.drift;
}

void Tally::pass(std::int64_t now_ns, std::time_t time, const State& state) {
  const auto step_s = std::clamp(ns_to_seconds(now_ns - passed_ns_), 0.0, kLongestStep_s);
  passed_ns_ = now_ns;
  day_.up_s += step_s;
  (state.is_dark ? day_.dark_s : day_.lit_s) += step_s;
  // A fault stays to be seen for its whole minute.
  if (auto& minute = day_.minutes[minute_of_day(time)]; minute != 'f')
    minute = state.has_fault ? 'f' : state.is_dark ? 'd' : 'l';
  day_.counted_until = time;
}

}  // namespace handcast::watch
