// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "calib/solve/tracker/fit_tracker.hpp"

namespace handcast::calib {

/// The tips of one hand at one time, thumb to little finger.
inline constexpr std::array<std::string_view, 5> kTipNames{"thumb", "index finger", "middle finger",
                                                           "ring finger", "little finger"};
inline constexpr int kIndexTip = 1;  ///< in kTipNames

/// What a tracker saw of a hand on whose index finger a reflector is: TrackerSample::points_m are
/// the five tips of kTipNames.
struct TrackedTips {
  std::string_view side;  ///< "left"
  std::vector<TrackerSample> samples;
};

/// fit_tracker() by a reflector on an index finger tip. `hands`: what the tracker saw; the
/// sightings are of the reflector, whose Sighting::point is kIndexTip. Of several hands, the one
/// counts with which most sightings fit. The findings also say if the reflector was on another
/// finger all the time, or on the other hand for a while. Errors: as fit_tracker(); bad_data if no
/// hand has samples.
Result<TrackerFit> fit_reflector(const CameraModel& camera, std::span<const TrackedTips> hands,
                                 std::span<const Sighting> sightings);

}  // namespace handcast::calib
