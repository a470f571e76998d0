// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/tracker/fit_tracker.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"

/// What a call does about the place of a tracker in place of the step `tracker`: --points judges
/// recorded points of a reflector, for those who have them from another program; --correct corrects
/// a tracker that has moved.
namespace handcast::calibrate {

/// A reflector that camera and tracker saw at the same times.
struct RecordedPoints {
  std::vector<calib::TrackerSample> samples;  ///< of one point
  std::vector<calib::Sighting> sightings;
};

/// The rate of points without times.
inline constexpr double kPoints_hz = 100;

/// Reads a folder: 2dpoints.npy (n x 2, px of the camera's image as the lens forms it),
/// 3dpoints.npy (n x 3, mm in the tracker's axes), and, if it is there, timestamps.npy (n, us);
/// without it, the points came at kPoints_hz. Errors: bad_config (a file cannot be read), bad_data
/// (other shapes, times that are no numbers).
Result<RecordedPoints> read_points(const std::filesystem::path& folder,
                                   const calib::CameraModel& camera);

/// The outcome of such points for a person, one line each: how good they are, the camera's place
/// with the spread that they allow, and what is wrong.
std::vector<std::string> describe_points(const calib::TrackerFit& fit);

/// Fits the points of a folder and prints describe_points(). Errors: those of read_points() and
/// calib::fit_tracker(); bad_data if the points are poor.
Result<void> judge_points(const std::filesystem::path& folder, const calib::CameraModel& camera);

/// Corrects the place of a tracker that has moved a little, by hands that are held still in front
/// of a rig that is up (calib::DriftWatch): shows what it found, asks, and writes the calibration
/// file; the one before it is kept. `used`: the calibration of the rig's services. Errors:
/// bad_config (the rig names no calibration), bad_data (the tracker has not moved beyond doubt, or
/// too far), those of the streams and of the file.
Result<void> correct_tracker(const Options& options, const config::Rig& rig,
                             const calib::Calibration& used);

}  // namespace handcast::calibrate
