// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/simulate/sensor_feed.hpp"

/// The sensors' results as tables, for methods that run outside handcast: what the twin's tracker
/// and detector delivered, the truth, and what another method made of the images.
///
/// A table is a .csv file with a line of names, or an array (rows, columns) of a .npy file. A row
/// is a hand: origin_ns (when the sensor saw it), arrival_ns (when the result was there, both in
/// virtual time), side (0 left, 1 right, -1: no hand was found), and
/// - of poses: the confidence, then for each of the 26 joints x, y, z (m, tracker space), qx, qy,
/// qz,
///   qw, radius (m);
/// - of landmarks: the presence, then for each of the 21 landmarks x, y (px of the image as the
/// lens
///   forms it), confidence, sigma (px).
/// Rows of both hands with the same two times are one message.
namespace handcast::simulate {

/// Reads such a file. Errors: bad_config (it cannot be opened, or has another number of columns),
/// bad_data (a value that no sensor delivers; the sentence names the row).
/// @{
Result<std::vector<SensorEvent>> read_poses(const std::filesystem::path& file);
Result<std::vector<SensorEvent>> read_landmarks(const std::filesystem::path& file,
                                                const calib::CameraModel& lens);
/// @}

/// Writes poses.csv and landmarks.csv, what the cascade got; true_poses.csv and true_landmarks.csv,
/// the true hands in the middle of each exposure; images.csv, the times of the images. Errors:
/// those of write_whole().
Result<void> write_exchange(const std::filesystem::path& folder,
                            const std::vector<SensorEvent>& events,
                            const std::vector<Exposure>& exposures, const twin::Twin& twin,
                            const calib::CameraModel& lens);

}  // namespace handcast::simulate
