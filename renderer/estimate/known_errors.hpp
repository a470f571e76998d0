// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "calib/calibration.hpp"
#include "renderer/estimate/error_filter.hpp"

namespace handcast::renderer {

/// What an image shows of a hand, and the tracker's hand at that time.
struct Sighting {
  std::int64_t origin_ns;
  HandJoints reported;
  msg::HandLandmarks seen;
  AbruptChange abrupt;
  float rest = 0;  ///< 1: the landmarks rest, 0: they move
};

/// The estimate of the errors, and what it was some seconds before. A tracker that loses the hand
/// little by little misleads the estimate, as each step is likely. When it has the hand again, an
/// earlier estimate is right: the present one contradicts what is seen, or needs larger errors. One
/// thread.
class KnownErrors {
 public:
  /// Adds a sighting to the estimate. If that cannot explain it, one of the earlier ones is tried,
  /// the next of them for each sighting, and is the estimate from then on. Returns false, and
  /// learns nothing, if that cannot either.
  bool add(const calib::CameraModel& camera, const Sighting& sighting);
  /// The tracker may put the hand elsewhere from now on: if no estimate can explain the next
  /// sightings, where it puts the hand is forgotten.
  void doubt_place() { is_doubtful_ = true; }

  /// The tracker's errors that are expected at a time.
  HandErrors errors_at(std::int64_t time_ns) const;

 private:
  struct Known {
    ErrorFilter errors;
    std::int64_t time_ns = 0;
    bool explain(const calib::CameraModel& camera, const Sighting& sighting);
  };
  bool recall(const calib::CameraModel& camera, const Sighting& sighting);
  void compare(const calib::CameraModel& camera, const Sighting& sighting);
  void remember();

  Known now_, trial_;
  std::array<Known, 3> earlier_;  ///< the newest first
  std::size_t next_ = 0;          ///< the earlier one that is tried next; 0 again after the last
  std::size_t rivals_ = 0;        ///< earlier ones that are still to be compared
  bool is_doubtful_ = false;
};

}  // namespace handcast::renderer
