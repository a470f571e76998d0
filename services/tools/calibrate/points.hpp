// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"

/// Recorded points of a reflector, for those who have them from another program.
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

}  // namespace handcast::calibrate
