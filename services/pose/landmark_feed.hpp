// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "ipc/ring/reader.hpp"
#include "services/pose/pose_source.hpp"

namespace handcast::pose {

/// The landmarks of the cameras, on their way to a source. One thread.
class LandmarkFeed {
 public:
  using Ring = Result<ipc::Reader<msg::Landmarks>>;

  /// `rings`: landmarks.hands and landmarks2.hands. `calibration`: the id of the rig's; landmarks
  /// of another one are not passed on.
  LandmarkFeed(std::array<Ring, kMostViews> rings, std::uint32_t calibration)
      : rings_(std::move(rings)), calibration_(calibration) {}

  /// Passes what has arrived to the source. If it needs landmarks, waits for them: 50 ms, or with
  /// two views 2 ms for the awaited one. Errors: timeout (nothing arrived, which is no fault: the
  /// first landmarks come after the service is ready), bad_data (another calibration), those of
  /// the ring.
  Result<void> pass_on(PoseSource& source);
  /// The next landmarks of the first view that were not read yet; empty if there are none.
  std::optional<msg::Landmarks> next();

 private:
  Result<void> pass_on(PoseSource& source, int view, Deadline deadline);

  std::array<Ring, kMostViews> rings_;
  std::uint32_t calibration_;
};

}  // namespace handcast::pose
