// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "calib/calibration.hpp"
#include "config/sections/projector.hpp"

namespace handcast::calib {

/// The calibration with a projector image of `factor` times the width and height, which covers the
/// same area.
Calibration with_scaled_projector(const Calibration& calibration, double factor);

/// Reads a calibration file, whose projector image is an output frame, and returns the calibration
/// for a sub-frame, in whose pixels everything is drawn and scored. Errors: those of
/// load_calibration(); bad_config (the output frame cannot be halved).
Result<Calibration> load_calibration(const std::filesystem::path& file, config::Packing packing);

/// Reads the calibration of a rig: that of `file` for `first`, and, unless `second` has no back
/// end, its projector. Errors: those of load_calibration(); bad_config (the file of the second one
/// is of another camera).
Result<Calibration> load_calibration(const std::filesystem::path& file,
                                     const config::Projector& first,
                                     const config::SecondProjector& second);

/// The calibration for the output frame, from that for a sub-frame.
Calibration output_of(const Calibration& sub_frame, config::Packing packing);

}  // namespace handcast::calib
