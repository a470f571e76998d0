// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "renderer/filter/landmark_filter.hpp"

namespace handcast::renderer {

/// Where landmarks are expected.
struct ExpectedPoints {
  std::array<glm::vec2, kLandmarks> px{};  ///< undistorted camera px
  std::array<bool, kLandmarks> known{};    ///< false: `px` of this landmark is not valid
};
/// The medians in x and in y (of an even number, the larger of the two in the middle). `values`
/// must not be empty; their order changes.
glm::vec2 median_of(std::span<glm::vec2> values);

/// The displacement of the seen landmarks from the expected ones that all have in common: the
/// length of the vector of the medians in x and in y. 0 if no landmark is both seen and expected.
float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected);

/// Corrects exchanged fingers: a detector may mistake one finger for another for a while. Fingers
/// whose landmarks lie at each other's expected places are exchanged. A detector that contradicts
/// the expectation for 500 ms is accepted as it is, unless the tracker contradicts it, too. One
/// thread.
class FingerOrder {
 public:
  /// The landmarks with the fingers in the right order. `expected`: the landmarks at `origin_ns`;
  /// `by_tracker`: the same by the tracker and the offset of the hand as a whole. Fingers without
  /// known landmarks are left as they are.
  msg::HandLandmarks mended(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                            const ExpectedPoints& expected, const ExpectedPoints& by_tracker);

 private:
  std::optional<std::int64_t> wrong_since_ns_;
};

/// Judges the offsets of a finger that step by more than a tracker's error changes from one image
/// to the next: the tracker's finger has snapped, or two fingers have become one for the detector,
/// or are two again. One thread.
class FingerSteps {
 public:
  /// What is to be done with the new offsets of a finger.
  enum class Verdict : std::uint8_t {
    usual,  ///< no step
    hold,   ///< the landmarks have jumped: leave them out
    anew,   ///< begin anew from them
  };
  /// By finger, thumb first.
  using Verdicts = std::array<Verdict, kFingers>;

  /// `seen`: the landmarks of an image. `expected`: the same by the offsets so far; `common`: by
  /// the offset that the hand has as a whole; `alone`: by the landmarks' own motion. A step that
  /// the landmarks' own motion explains is the tracker's, whose finger has snapped, and begins
  /// anew. So does one towards the common offset, and one away from it after it has lasted 500 ms.
  Verdicts judge(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const ExpectedPoints& expected, const ExpectedPoints& common,
                 const ExpectedPoints& alone);

 private:
  std::array<std::optional<std::int64_t>, kFingers> held_since_ns_{};
};

}  // namespace handcast::renderer
