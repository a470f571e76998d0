// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/ledger.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kRecent_ns = 2 * kSecond_ns;
/// Limits the memory, however much a service publishes.
constexpr std::size_t kMostRecent = 1 << 16;

double per_second(std::uint64_t count, std::int64_t span_ns) {
  return span_ns > 0 ? static_cast<double>(count) / ns_to_seconds(span_ns) : 0.0;
}

}  // namespace

std::string name_at_instance(std::string_view name, std::string_view service) {
  return std::string(name) + (service.ends_with('2') ? "2" : "");
}

void FrameCount::add(const msg::Header& frame, std::uint64_t missed) {
  const auto time_ns = frame.published_ns;
  const auto frames = missed + 1;
  if (total_ == 0) first_ns_ = time_ns;
  total_ += frames;
  if (time_ns - first_ns_ >= kSecond_ns) settled_ += frames;
  newest_origin_ns_ = frame.origin_ns;
  recent_.push_back({time_ns, frames});
  while (time_ns - recent_.front().time_ns > kRecent_ns || recent_.size() > kMostRecent)
    recent_.pop_front();
}

double FrameCount::recent_hz(std::int64_t now_ns) const {
  const auto from_ns = std::max(now_ns - kRecent_ns, first_ns_);
  std::uint64_t frames = 0;
  for (const auto& arrival : recent_)
    if (arrival.time_ns > from_ns) frames += arrival.frames;
  return per_second(frames, now_ns - from_ns);
}

double FrameCount::held_hz(std::int64_t now_ns) const {
  return per_second(settled_, now_ns - first_ns_ - kSecond_ns);
}

std::optional<double> FrameCount::newest_age_ms(std::int64_t now_ns) const {
  if (total_ == 0 || newest_origin_ns_ == 0) return std::nullopt;  // dark frames have no origin
  return ns_to_ms(now_ns - newest_origin_ns_);
}

void StageTimes::add(std::int64_t ended_ns, std::int64_t span_ns) {
  whole_run_.add(span_ns);
  const auto number = ended_ns / kSecond_ns;
  auto& second = seconds_[static_cast<std::size_t>(number) % kWindow_s];
  if (second.number != number) second = {number, {}};
  second.times.add(span_ns);
}

Histogram StageTimes::recent(std::int64_t now_ns) const {
  Histogram sum;
  for (const auto& second : seconds_)
    if (now_ns / kSecond_ns - second.number < kWindow_s) sum.add(second.times);
  return sum;
}

void Ledger::add(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed) {
  if (marks.count == 0) return;
  auto& frames = frames_[std::string(service)];
  frames.add(marks.header, missed);
  const auto count = std::min<std::size_t>(marks.count, marks.marks.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& mark = marks.marks[i];
    const auto stage = static_cast<std::size_t>(mark.stage);
    if (stage >= msg::kStageNames.size()) continue;  // values from shared memory may be invalid
    stages_[name_at_instance(msg::kStageNames[stage], service)].add(mark.end_ns,
                                                                    mark.end_ns - mark.begin_ns);
    if (const auto note = msg::light_note_in(mark.detail); note && mark.stage == msg::Stage::light)
      lights_[std::string(service)].add(*note);
    if (mark.stage == msg::Stage::capture) lost_images_.add(msg::losses_in(mark.detail));
    if (mark.stage == msg::Stage::sample) {
      const auto faults = msg::tracker_faults_in(mark.detail);
      for (std::size_t k = 0; k < faults.count.size(); ++k) tracker_faults_[k] += faults.count[k];
    }
    if (mark.stage == msg::Stage::detect)
      detectors_[std::string(service)] = msg::detector_note_in(mark.detail);
    if (mark.stage == msg::Stage::frame && frames.is_settled())
      slow_frames_[std::string(service)].add(mark.end_ns - mark.begin_ns,
                                             msg::frame_delay_in(mark.detail));
    if (mark.stage == msg::Stage::bridge) bridge_ = msg::bridge_note_in(mark.detail);
    if (mark.stage == msg::Stage::watch) tracker_drift_ = msg::drift_note_in(mark.detail);
    if (mark.stage != msg::Stage::correct) continue;
    for (const auto side : {msg::Side::left, msg::Side::right})
      if (const auto rung = msg::rung_in(mark.detail, side))
        ++rungs_[static_cast<std::size_t>(*rung)];
  }
}

msg::DetectorNote Ledger::detector(std::string_view service) const {
  const auto found = detectors_.find(service);
  return found == detectors_.end() ? msg::DetectorNote{} : found->second;
}

const FrameCount& Ledger::frames(std::string_view service) const {
  static const FrameCount kNone;
  const auto found = frames_.find(service);
  return found == frames_.end() ? kNone : found->second;
}

}  // namespace handcast::supervisor
