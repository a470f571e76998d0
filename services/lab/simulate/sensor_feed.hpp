// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/simulate/frame_detector.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/pose/lift/lifter.hpp"

namespace handcast::simulate {

/// A message and the time at which it reaches the projector.
struct SensorEvent {
  std::int64_t arrival_ns = 0;                           ///< virtual time since the epoch
  std::variant<msg::HandPoses, msg::Landmarks> message;  ///< from the tracker or the detector
};

/// The input of the cascade in virtual time: messages and images with their times of arrival, and
/// nothing else of the world. `now_ns` must not decrease from call to call.
class SensorFeed {
 public:
  virtual ~SensorFeed() = default;
  /// The messages that have arrived by `now_ns` since the last call, in the order of arrival.
  virtual std::vector<SensorEvent> until(std::int64_t now_ns) = 0;
  /// The newest camera frame in memory at `now_ns`; empty before the first.
  virtual std::optional<Exposure> newest_exposure(std::int64_t now_ns) = 0;
  /// Writes the image of a frame to `pixels`, which has the size of the camera's image.
  virtual void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) = 0;
};

class SecondView;

/// What takes the place of the tracker or the detector of the twin (exchange.hpp), in the order of
/// arrival.
struct SentMessages {
  std::optional<std::vector<SensorEvent>> poses, landmarks;
};

/// Called after each run of a detector.
using OnDetection = std::function<void(const Exposure&, const Detection&)>;

/// Makes the feed of the twin's tracker and camera and a detector that runs back to back. `twin`
/// must outlive it. `lifter`: a rig without a tracker (pose.backend "none"), whose poses are lifted
/// from the landmarks and arrive 0.2 ms after them. `second`: a rig with pose.backend "stereo".
/// `sent`: what takes the place of the tracker and the detector.
std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin,
                                           std::unique_ptr<FrameDetector> detector,
                                           OnDetection on_detection = {},
                                           const std::optional<pose::Lifter>& lifter = {},
                                           std::shared_ptr<SecondView> second = {},
                                           const SentMessages& sent = {});
/// The same with the twin's model of a detector.
std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin);

/// Passes on the messages of another feed and counts the detections that hold a hand.
class CountingFeed final : public SensorFeed {
 public:
  /// Takes over the feed to be counted.
  explicit CountingFeed(std::unique_ptr<SensorFeed> source) : source_(std::move(source)) {}

  std::vector<SensorEvent> until(std::int64_t now_ns) override {
    auto events = source_->until(now_ns);
    detections_ += static_cast<int>(std::ranges::count_if(events, [](const SensorEvent& event) {
      const auto* landmarks = std::get_if<msg::Landmarks>(&event.message);
      return landmarks && landmarks->count > 0;
    }));
    return events;
  }
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    return source_->newest_exposure(now_ns);
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override {
    source_->image(exposure, pixels);
  }

  /// Detections with at least one hand so far.
  int detections() const { return detections_; }

 private:
  std::unique_ptr<SensorFeed> source_;
  int detections_ = 0;
};

}  // namespace handcast::simulate
