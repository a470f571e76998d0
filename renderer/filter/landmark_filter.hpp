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

/// P at a time, as it is known at the moment of the call. Empty if there is none.
using TrackerAt = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// The true positions of the 21 landmarks of one hand at a time. Only a simulator has them.
using LandmarkOracle = std::function<std::optional<LandmarkPoints>(std::int64_t time_ns)>;

/// Carries the detected landmarks Q of one hand to the time of the photons: Q̂. See
/// `docs/method.md#filter` and paper, "Temporal Filtering". One thread.
class LandmarkFilter {
 public:
  virtual ~LandmarkFilter() = default;

  /// Adds a detection that was seen at `origin_ns` and arrived at `now_ns`. Detections may arrive
  /// late or out of order; points may be missing (confidence 0). `tracker` is not called after the
  /// function has returned.
  virtual void detection(std::int64_t now_ns, std::int64_t origin_ns,
                         const msg::HandLandmarks& seen, const TrackerAt& tracker) = 0;

  /// A tracker sample arrived at `now_ns`: P may jump before the next at().
  virtual void tracker_sample(std::int64_t now_ns) = 0;

  /// Q̂ for the photons at `target_ns`. `tracker`: P at that time. Empty if there is nothing to
  /// correct P with. Call it once per frame: filters remember their output.
  virtual std::optional<LandmarkPoints> at(std::int64_t now_ns, std::int64_t target_ns,
                                           const LandmarkPoints& tracker) = 0;
};

/// True if the hand moves with P between detections (methods paper and articulated). Then it shares
/// the error of P's prediction, which late registration corrects. The Q̂ of naive, kalman and ideal
/// does not depend on P; none has no Q̂.
bool moves_with_tracker(const config::Filter& settings);

/// The filter of config::Filter::method. `oracle` is used by "ideal" only, which corrects nothing
/// without it.
std::unique_ptr<LandmarkFilter> make_landmark_filter(const config::Filter& settings,
                                                     LandmarkOracle oracle = {});

}  // namespace handcast::renderer
