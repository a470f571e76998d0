// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "calib/solve/lens/lens_fit.hpp"

/// What the steps `lens` and `lens2` share with others.
namespace handcast::calibrate {

/// What to do next. `wanted`: images that are enough; `place`: where the board was not seen yet, or
/// how it was not tilted; empty if it was everywhere.
std::string lens_advice(std::size_t views, std::size_t wanted, const std::string& place);

/// How well a lens is known, for the steps that stand on it: the calibration file has only the lens
/// itself. Writes the lens and its covariance to FOLDER/STEP.covariance. Errors: unavailable.
Result<void> remember_lens(const std::filesystem::path& folder, const std::string& step,
                           const calib::LensFit& fit);

/// The covariance of this lens; nothing if another one was measured last, or none.
std::optional<calib::LensCovariance> recall_lens(const std::filesystem::path& folder,
                                                 const std::string& step,
                                                 const calib::CameraModel& camera);

}  // namespace handcast::calibrate
