// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "calib/solve/lens/lens_fit.hpp"
#include "ipc/base/result.hpp"

/// How well a lens is known, kept in the session's folder for the steps that stand on it: the
/// calibration file has only the lens itself.
namespace handcast::calibrate {

/// Writes the lens and its covariance to FOLDER/STEP.covariance. Errors: unavailable.
Result<void> remember_lens(const std::filesystem::path& folder, const std::string& step,
                           const calib::LensFit& fit);

/// The covariance of this lens; nothing if another one was measured last, or none.
std::optional<calib::LensCovariance> recall_lens(const std::filesystem::path& folder,
                                                 const std::string& step,
                                                 const calib::CameraModel& camera);

}  // namespace handcast::calibrate
