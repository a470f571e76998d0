// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "services/landmarks/geometry/points.hpp"

namespace handcast::detect {

/// A PNG or JPEG picture as renderer::read_camera_picture() reads it. Errors: bad_config.
Result<renderer::Image<std::uint8_t>> read_grey(const std::filesystem::path& file);

/// A tracker's joints in a picture, as the 21 landmarks in pixels. The .npy file has the shape
/// (21,2), in pixels, or (42,2), in Leap's order, -1..1 with y up. Errors: bad_config, bad_data.
Result<landmarks::Points> read_joints(const std::filesystem::path& file, int width_px,
                                      int height_px);

}  // namespace handcast::detect
