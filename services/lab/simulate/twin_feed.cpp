// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/lab/simulate/exchange.hpp"
#include "services/lab/simulate/second_view.hpp"
#include "services/lab/simulate/sensor_feed.hpp"

namespace handcast::simulate {
namespace {

/// From the landmarks to their poses in the projector: the lift, and a second ring.
constexpr std::int64_t kLift_ns = 200'000;

class TwinFeed : public SensorFeed {
 public:
  TwinFeed(const twin::Twin& twin, std::unique_ptr<FrameDetector> detector,
           OnDetection on_detection, const std::optional<pose::Lifter>& lifter,
           std::shared_ptr<SecondView> second, SentMessages sent)
      : twin_(twin),
        on_detection_(on_detection),
        detector_(twin, std::move(detector), std::move(on_detection)),
        lifter_(lifter),
        second_(std::move(second)),
        sent_(std::move(sent)) {}

  std::vector<SensorEvent> until(std::int64_t now_ns) override {
    std::vector<SensorEvent> events;
    if (sent_.poses) {
      take_sent(*sent_.poses, next_pose_, now_ns, events);
    } else if (second_) {
      take_lifted(now_ns, events);
    } else if (!lifter_) {
      take_tracker_samples(now_ns, events);
    }
    std::ranges::stable_sort(events, {}, &SensorEvent::arrival_ns);
    const std::vector<SensorEvent> poses = second_ ? events : std::vector<SensorEvent>{};
    if (sent_.landmarks) {
      take_sent_landmarks(now_ns, events);
    } else {
      detector_.until(now_ns, events);
    }
    if (lifter_) lift(now_ns, events);
    if (second_)
      for (const auto& made : second_->until(now_ns, events, poses)) lifted_.push_back(made);
    std::ranges::stable_sort(events, {}, &SensorEvent::arrival_ns);
    return events;
  }

  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    for (; twin_.camera_arrival_ns(next_frame_) <= now_ns; ++next_frame_)
      if (!twin_.camera_lost(next_frame_)) newest_ = next_frame_;
    if (!newest_) return std::nullopt;
    return Exposure{*newest_, twin_.camera_origin_ns(*newest_), twin_.camera_stamp_ns(*newest_)};
  }

  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override {
    twin_.camera_image(exposure.frame_id, pixels);
  }

 private:
  /// Samples may overtake one another: every sample taken before `now_ns` that has not arrived
  /// stays pending.
  void take_tracker_samples(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    for (; twin_.tracker_time_ns(next_sample_) <= now_ns; ++next_sample_)
      pending_.push_back(twin_.tracker_sample(next_sample_));
    std::erase_if(pending_, [&](const twin::Twin::TrackerSample& sample) {
      if (sample.arrival_ns > now_ns) return false;
      if (sample.poses.count > 0) events.push_back({sample.arrival_ns, sample.poses});
      return true;
    });
  }

  static void take_sent(const std::vector<SensorEvent>& sent, std::size_t& next,
                        std::int64_t now_ns, std::vector<SensorEvent>& events) {
    for (; next < sent.size() && sent[next].arrival_ns <= now_ns; ++next)
      events.push_back(sent[next]);
  }

  void take_sent_landmarks(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    const auto before = next_landmarks_;
    take_sent(*sent_.landmarks, next_landmarks_, now_ns, events);
    for (auto i = before; i < next_landmarks_ && on_detection_; ++i) {
      const auto& event = (*sent_.landmarks)[i];
      const auto& landmarks = std::get<msg::Landmarks>(event.message);
      const auto exposure = exposure_of(landmarks.header.origin_ns);
      on_detection_(exposure, {landmarks, event.arrival_ns - exposure.origin_ns, 0});
    }
  }

  /// The exposure of the first image that is not older than `stamp_ns`. Landmarks come in about the
  /// order of their images.
  Exposure exposure_of(std::int64_t stamp_ns) {
    while (searched_ > 0 && twin_.camera_stamp_ns(searched_ - 1) >= stamp_ns) --searched_;
    while (twin_.camera_stamp_ns(searched_) < stamp_ns) ++searched_;
    return {searched_, twin_.camera_origin_ns(searched_), twin_.camera_stamp_ns(searched_)};
  }

  /// Adds the poses of the landmarks that have been lifted by `now_ns`.
  void lift(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    for (const auto& event : events)
      if (const auto* landmarks = std::get_if<msg::Landmarks>(&event.message))
        lifted_.push_back({event.arrival_ns + kLift_ns, lifter_->lift(*landmarks)});
    take_lifted(now_ns, events);
  }

  void take_lifted(std::int64_t now_ns, std::vector<SensorEvent>& events) {
    std::erase_if(lifted_, [&](const SensorEvent& event) {
      if (event.arrival_ns > now_ns) return false;
      events.push_back(event);
      return true;
    });
  }

  const twin::Twin& twin_;
  OnDetection on_detection_;
  BackToBack detector_;
  std::optional<pose::Lifter> lifter_;
  std::shared_ptr<SecondView> second_;  ///< its poses arrive with the next call
  SentMessages sent_;
  std::size_t next_pose_ = 0, next_landmarks_ = 0;
  std::uint64_t searched_ = 0;       ///< the frame of the last landmarks that were sent
  std::vector<SensorEvent> lifted_;  ///< arrive after the last call
  std::vector<twin::Twin::TrackerSample> pending_;
  std::uint64_t next_sample_ = 0;
  std::uint64_t next_frame_ = 0;
  std::optional<std::uint64_t> newest_;  ///< frame that has arrived
};

}  // namespace

std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin,
                                           std::unique_ptr<FrameDetector> detector,
                                           OnDetection on_detection,
                                           const std::optional<pose::Lifter>& lifter,
                                           std::shared_ptr<SecondView> second,
                                           const SentMessages& sent) {
  return std::make_unique<TwinFeed>(twin, std::move(detector), std::move(on_detection), lifter,
                                    std::move(second), sent);
}

std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin) {
  return make_twin_feed(twin, make_twin_detector(twin));
}

}  // namespace handcast::simulate
