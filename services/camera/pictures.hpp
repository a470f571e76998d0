// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::camera {

/// Decodes the grey PNG images of a folder, in the order of their names. Errors: bad_config (the
/// folder is missing or has no images, a file is not an image or has another size, or the images
/// take more than 1 GiB).
Result<std::vector<renderer::Image<std::uint8_t>>> read_pictures(
    const std::filesystem::path& folder, int width_px, int height_px);

}  // namespace handcast::camera
