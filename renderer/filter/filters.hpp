// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "renderer/filter/landmark_filter.hpp"

/// @file
/// The filters behind make_landmark_filter(), one file each, and what they share. Included by the
/// filters, by their tests and by users of TrackerMemory.

namespace handcast::renderer {

/// A filter that can be reset.
class CarryFilter : public LandmarkFilter {
 public:
  void tracker_sample(std::int64_t) override {}
  /// Drops what was learned from detections. What is remembered of the tracker is kept.
  virtual void forget() = 0;
};

/// Q̂ = Q: the landmarks as they were seen.
std::unique_ptr<CarryFilter> make_naive_filter();
/// The newest offset Q - P of each point, added to P (paper, "Moving Least Squares Deformation").
std::unique_ptr<CarryFilter> make_paper_filter(const config::Filter& settings);
/// A constant-velocity Kalman filter on Q, without the tracker.
std::unique_ptr<CarryFilter> make_kalman_filter(const config::Filter& settings);
/// A constant-velocity Kalman filter on Q - P.
std::unique_ptr<CarryFilter> make_offset_kalman(const config::Filter& settings);
/// A one-euro filter on Q - P.
std::unique_ptr<CarryFilter> make_one_euro_filter(const config::Filter& settings);

/// Wraps `inner`: its correction fades out within 100 ms once the newest detection is older than
/// lost_ms, and the jumps of its output are smoothed (JumpBlend).
std::unique_ptr<LandmarkFilter> make_settled_filter(const config::Filter& settings,
                                                    std::unique_ptr<CarryFilter> inner);

/// The landmarks that recent frames were drawn with, by target time; the last 150 ms. A filter
/// without hindsight takes P at the time of an image from here: as it was predicted for the frame
/// of that time, from the tracker samples that had arrived by then.
class TrackerMemory {
 public:
  /// Adds the landmarks of the frame for `target_ns`. Entries at or after that time are dropped.
  void remember(std::int64_t target_ns, const LandmarkPoints& tracker);
  /// The landmarks at `time_ns`, interpolated linearly. Empty outside the remembered times.
  std::optional<LandmarkPoints> at(std::int64_t time_ns) const;

 private:
  struct Entry {
    std::int64_t target_ns;
    LandmarkPoints tracker;
  };
  std::deque<Entry> entries_;  ///< by target time
};

/// P at the time of a detection: as it was predicted then if `memory` is given (not nullptr) and
/// has it, else by hindsight from `tracker`. Empty if neither has it.
std::optional<LandmarkPoints> tracker_then(const TrackerAt& tracker, const TrackerMemory* memory,
                                           std::int64_t origin_ns);

/// Sets the unknown offsets to the mean of the known ones. Does nothing if none is known.
void lend_offsets(std::array<glm::vec2, kLandmarks>& offsets,
                  const std::array<bool, kLandmarks>& known);
/// P plus the offsets, the unknown ones from lend_offsets(). Empty if no offset is known.
std::optional<LandmarkPoints> moved_by(const LandmarkPoints& tracker,
                                       std::array<glm::vec2, kLandmarks> offsets,
                                       const std::array<bool, kLandmarks>& known);

/// Where landmarks are expected.
struct ExpectedPoints {
  std::array<glm::vec2, kLandmarks> px{};  ///< undistorted camera px
  std::array<bool, kLandmarks> known{};    ///< false: `px` of this landmark is not valid
};
/// The displacement of the seen landmarks from the expected ones that all have in common: the
/// length of the vector of the medians in x and in y. 0 if no landmark is both seen and expected.
float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected);

}  // namespace handcast::renderer
