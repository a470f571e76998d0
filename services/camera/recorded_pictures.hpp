// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/camera/played_pictures.hpp"

namespace handcast::camera {

/// The images of a recording of `handcast record`, at the times at which they were published.
/// Errors: those of StreamReader, bad_config (an image has another size).
Result<PlayedPictures> open_recorded_pictures(const std::filesystem::path& folder,
                                              const PlayedAs& as);

}  // namespace handcast::camera
