// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/image.hpp"
#include "services/evaluation/simulate/exposure.hpp"
#include "services/evaluation/simulate/frame_detector.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// A message and the moment it reaches the projector.
struct SensorEvent {
  std::int64_t arrival_ns = 0;
  std::variant<msg::HandPoses, msg::Landmarks> message;
};

/// What reaches the cascade, and when: all that it may know of the world. Virtual time, asked for
/// in ascending order.
class SensorFeed {
 public:
  virtual ~SensorFeed() = default;
  /// The messages that arrived up to `now_ns` and were not given yet, in the order of their
  /// arrival.
  virtual std::vector<SensorEvent> until(std::int64_t now_ns) = 0;
  /// The newest camera frame in memory at `now_ns`.
  virtual std::optional<Exposure> newest_exposure(std::int64_t now_ns) = 0;
  virtual void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) = 0;
};

/// Called with every frame a detector was shown.
using OnDetection = std::function<void(const Exposure&, const Detection&)>;

/// The twin's tracker and camera, and a detector back to back, run in virtual time.
std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin,
                                           std::unique_ptr<FrameDetector> detector,
                                           OnDetection on_detection = {});
/// With the twin's model of a detector.
std::unique_ptr<SensorFeed> make_twin_feed(const twin::Twin& twin);

}  // namespace handcast::simulate
