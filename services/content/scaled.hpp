// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"

namespace handcast::content {

/// A picture (RGBA8, premultiplied) in another size: each pixel is the mean of the area that it
/// covers where the picture becomes smaller, and interpolated linearly where it becomes larger. Of
/// levels; edges are repeated.
renderer::Texture scaled(renderer::View<const std::uint32_t> picture, int width, int height);

/// How a picture is put into another size: stretched; whole, with transparent bands; or filling it,
/// with what juts out cut off. In the latter two its middle remains in the middle.
enum class Fit { stretch, contain, cover };
renderer::Texture fitted(renderer::View<const std::uint32_t> picture, int width, int height,
                         Fit fit);

}  // namespace handcast::content
