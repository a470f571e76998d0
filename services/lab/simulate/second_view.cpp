// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/second_view.hpp"

#include <algorithm>

namespace handcast::simulate {

void BackToBack::until(std::int64_t now_ns, std::vector<SensorEvent>& events) {
  waiting_.insert(waiting_.end(), events.begin(), events.end());
  while (true) {
    if (!under_way_) {
      const auto frame = next_frame(now_ns);
      const auto begin_ns = std::max(free_ns_, twin_.camera_arrival_ns(frame));
      if (begin_ns > now_ns) return;
      under_way_ = begin(frame, begin_ns);
    }
    if (under_way_->done_ns > now_ns) return;
    if (under_way_->landmarks) events.push_back({under_way_->done_ns, *under_way_->landmarks});
    free_ns_ = under_way_->done_ns;
    under_way_.reset();
  }
}

/// The frame of the next run, or one that arrives after `now_ns`.
std::uint64_t BackToBack::next_frame(std::int64_t now_ns) const {
  auto next = static_cast<std::uint64_t>(last_frame_ + 1);
  while (twin_.camera_lost(next) && twin_.camera_arrival_ns(next) <= now_ns) ++next;
  for (auto frame = next + 1; twin_.camera_arrival_ns(frame) <= free_ns_; ++frame)
    if (!twin_.camera_lost(frame)) next = frame;
  return next;
}

BackToBack::Run BackToBack::begin(std::uint64_t frame, std::int64_t begin_ns) {
  tell(begin_ns);
  const Exposure exposure{frame, twin_.camera_origin_ns(frame), twin_.camera_stamp_ns(frame)};
  const auto detection = detector_->detect(runs_++, exposure);
  if (on_detection_) on_detection_(exposure, detection);
  last_frame_ = static_cast<std::int64_t>(frame);
  return {std::max(exposure.origin_ns + detection.age_ns, begin_ns), detection.landmarks};
}

/// Passes on the samples that have arrived when a run begins, and no later ones.
void BackToBack::tell(std::int64_t begin_ns) {
  const auto later = std::ranges::find_if(
      waiting_, [&](const SensorEvent& event) { return event.arrival_ns > begin_ns; });
  for (auto event = waiting_.begin(); event != later; ++event)
    if (const auto* poses = std::get_if<msg::HandPoses>(&event->message)) detector_->tell(*poses);
  waiting_.erase(waiting_.begin(), later);
}

namespace {

/// From the landmarks to their poses in the projector: the fit (0.1 ms, at most 0.6), and a second
/// ring.
constexpr std::int64_t kFit_ns = 300'000;

}  // namespace

Result<std::unique_ptr<SecondView>> SecondView::open(const config::Rig& rig,
                                                     const calib::Calibration& calibration) {
  const auto views = pose::stereo::views_of(calibration);
  if (!views) return tl::make_unexpected(views.error());
  constexpr auto kSecond = config::Viewpoint::second;
  auto twin = twin::Twin::create(rig, calibration, kSecond);
  if (!twin) return tl::make_unexpected(twin.error());
  auto detector = open_frame_detector(rig, calibration, **twin, kSecond);
  if (!detector) return fail_in("the second view", detector.error());
  auto tracker =
      pose::stereo::StereoTracker::open(rig, *views, glm::inverse(calibration.camera_from_tracker));
  if (!tracker) return tl::make_unexpected(tracker.error());
  return std::unique_ptr<SecondView>(
      new SecondView(std::move(*twin), std::move(*detector), *tracker, rig.pose.stereo));
}

std::vector<SensorEvent> SecondView::until(std::int64_t now_ns,
                                           const std::vector<SensorEvent>& events,
                                           const std::vector<SensorEvent>& poses) {
  struct Arrival {
    std::int64_t at_ns;
    int view;
    msg::Landmarks landmarks;
  };
  std::vector<Arrival> arrivals;
  const auto take = [&](int view, const std::vector<SensorEvent>& from) {
    for (const auto& event : from)
      if (const auto* landmarks = std::get_if<msg::Landmarks>(&event.message))
        arrivals.push_back({event.arrival_ns, view, *landmarks});
  };
  take(0, events);
  std::vector<SensorEvent> second = poses;
  detector_.until(now_ns, second);
  take(1, second);
  std::ranges::stable_sort(arrivals, {}, &Arrival::at_ns);
  std::vector<SensorEvent> made;
  for (const auto& arrival : arrivals) {
    sample(arrival.at_ns, made);
    pairing_.push(arrival.view, arrival.landmarks, arrival.at_ns);
    sample(arrival.at_ns, made);
  }
  sample(now_ns, made);
  return made;
}

/// Makes the samples that are due by `now_ns`.
void SecondView::sample(std::int64_t now_ns, std::vector<SensorEvent>& made) {
  while (const auto pair = pairing_.take(now_ns))
    made.push_back({now_ns + kFit_ns, tracker_.sample(pose::stereo::seen_of(*pair))});
}

}  // namespace handcast::simulate
