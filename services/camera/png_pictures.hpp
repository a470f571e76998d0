// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/camera/played_pictures.hpp"

namespace handcast::camera {

/// The grey PNG images of a folder, or of `camera` in it, in the order of their names, at the times
/// of camera_timestamps.npy; if there is no such file, at the rate of the settings. They are
/// decoded here, so they may take at most 1 GiB. Errors: bad_config (the folder is missing or has
/// no images, a file is not an image or has another size, the images take more than 1 GiB, the
/// times are wrong or not as many).
Result<PlayedPictures> open_png_pictures(const std::filesystem::path& folder, const PlayedAs& as);

/// The times of `count` images beside a file or in a folder: those of camera_timestamps.npy or, if
/// there is no such file, from `first_ns` on at `rate_hz`. Errors: bad_config (it has another
/// number of times), those of the file.
Result<std::vector<std::int64_t>> picture_times_ns(const std::filesystem::path& folder,
                                                   std::size_t count, double rate_hz,
                                                   std::int64_t first_ns);

}  // namespace handcast::camera
