// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "renderer/filter/expected_points.hpp"

namespace handcast::renderer {

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

}  // namespace handcast::renderer
