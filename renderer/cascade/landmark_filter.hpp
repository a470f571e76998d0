#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "config/sections/cascade.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {

using msg::kLandmarks;
using LandmarkPoints = std::array<glm::vec2, kLandmarks>;  ///< undistorted camera px, MediaPipe's order

/// Where the tracker says the 21 landmarks are (P) at a time, with what is known by now.
using TrackerAt = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// Where the 21 landmarks of one hand truly are: what only a simulator can say.
using LandmarkOracle = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// Carries old landmarks Q of one hand to the present (paper section "Temporal filtering"; METHOD section 2).
class LandmarkFilter {
 public:
  virtual ~LandmarkFilter() = default;

  /// A detection arrived now; it was seen at `origin_ns`. Detections may come late or out of order; points may be missing (confidence 0).
  virtual void detection(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen, const TrackerAt& tracker) = 0;

  /// A tracker sample arrived: outputs may jump, and the jump is to be blended in.
  virtual void tracker_sample(std::int64_t now_ns) = 0;

  /// Q̂ for the photons at `target_ns`, given P at that time; nothing when there is nothing to correct with.
  virtual std::optional<LandmarkPoints> at(std::int64_t now_ns, std::int64_t target_ns, const LandmarkPoints& tracker) = 0;
};

/// `oracle` is asked by method "ideal" alone, which corrects nothing where there is none.
std::unique_ptr<LandmarkFilter> make_landmark_filter(const config::Filter& settings, LandmarkOracle oracle = {});

}  // namespace handcast::renderer
