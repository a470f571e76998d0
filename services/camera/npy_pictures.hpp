// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/camera/played_pictures.hpp"

namespace handcast::camera {

/// The images of a .npy file, (n, height, width) of bytes, read from the disk; at the times of
/// camera_timestamps.npy beside it or, if there is no such file, at the rate of the settings.
/// Errors: bad_config (no such file, images of another size, other times than images), bad_data (a
/// malformed file).
Result<PlayedPictures> open_npy_pictures(const std::filesystem::path& file, const PlayedAs& as);

}  // namespace handcast::camera
