// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "config/sections/cascade.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Where the tracker says the 21 landmarks are (P) at a time, with what is known by now.
using TrackerAt = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// Where the 21 landmarks of one hand truly are: what only a simulator can say.
using LandmarkOracle = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// Carries old landmarks Q of one hand to the present (paper section "Temporal filtering"; METHOD
/// section 2).
class LandmarkFilter {
 public:
  virtual ~LandmarkFilter() = default;

  /// A detection arrived now; it was seen at `origin_ns`. Detections may come late or out of order;
  /// points may be missing (confidence 0).
  virtual void detection(std::int64_t now_ns, std::int64_t origin_ns,
                         const msg::HandLandmarks& seen, const TrackerAt& tracker) = 0;

  /// A tracker sample arrived: outputs may jump, and the jump is to be blended in.
  virtual void tracker_sample(std::int64_t now_ns) = 0;

  /// How far P can be believed from now on. A filter that takes P as it comes does not ask.
  enum class Tracker {
    heard,
    silent,  ///< P stays where the hand was last seen; the hand may not
  };
  virtual void tracker_is(Tracker) {}
  /// P is not where it would be had the hand moved there: what was known of Q - P is over.
  virtual void tracker_jumped() {}

  /// Q̂ for the photons at `target_ns`, given P at that time; nothing when there is nothing to
  /// correct with.
  virtual std::optional<LandmarkPoints> at(std::int64_t now_ns, std::int64_t target_ns,
                                           const LandmarkPoints& tracker) = 0;
};

/// Q̂ goes on from a detection as P does, and shares the error of P's prediction; late registration
/// mends that. Otherwise (naive, kalman, ideal) Q̂ knows nothing of P; none has no Q̂.
bool moves_with_tracker(const config::Filter& settings);

/// `oracle` is asked by method "ideal" alone, which corrects nothing where there is none.
std::unique_ptr<LandmarkFilter> make_landmark_filter(const config::Filter& settings,
                                                     LandmarkOracle oracle = {});

}  // namespace handcast::renderer
