// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "renderer/filter/expected_points.hpp"

namespace handcast::renderer {

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
