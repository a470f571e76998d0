// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/camera/played_pictures.hpp"

namespace handcast::camera {

/// The frames of a film, at the rate that it says; if it says none, at that of the settings.
/// Errors: bad_config (it is no film that OpenCV reads, of another size, or does not say its
/// length; this installation has no library for films).
Result<PlayedPictures> open_film_pictures(const std::filesystem::path& file, const PlayedAs& as);

}  // namespace handcast::camera
