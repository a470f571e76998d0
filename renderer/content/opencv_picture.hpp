#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/image.hpp"

/// The little this house needs of OpenCV's pictures.
namespace handcast::renderer {

/// A PNG or JPEG file as RGBA8, opaque. Errors (bad_config): no such file, not a picture, larger than 8192 px.
Result<Texture> read_picture(const std::string& file);

/// Black-on-nothing lettering as coverage (0..255), trimmed to a box `height` pixels high.
Image<std::uint8_t> lettering(const std::string& text, int height);

}  // namespace handcast::renderer
