// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::camera {

/// The grey PNG pictures of a folder in the order of their names, all of one size, decoded: at most
/// 1 GiB of them. Errors (bad_config): folder missing or without pictures, a file that is no
/// picture, another size, too much.
Result<std::vector<renderer::Image<std::uint8_t>>> read_pictures(
    const std::filesystem::path& folder, int width_px, int height_px);

}  // namespace handcast::camera
