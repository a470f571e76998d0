// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// How the values of a picture become light: a curve per channel, then a mixture of the channels.
struct ColourProfile {
  std::array<std::vector<float>, 3> light;  ///< of the values 0..65535: red, green, blue, 0..1
  glm::dmat3 srgb_from_rgb{1.0};            ///< of light
};

/// The profile of a picture whose values are light^gamma, in the primaries of sRGB.
ColourProfile profile_of_gamma(double gamma);

/// Reads an ICC profile (ICC.1:2010) with curves and a matrix, which cameras and screens have, or
/// with the curve of grey values, which fits grey pictures only. Errors (bad_data), as the ends of
/// sentences: of another kind, damaged.
Result<ColourProfile> read_icc_profile(std::string_view icc, bool picture_is_grey);
/// The name of an ICC profile: "Adobe RGB (1998)". Empty if it has none.
std::string name_of_icc_profile(std::string_view icc);

/// True if it differs from sRGB by two levels of 255 at most.
bool is_srgb(const ColourProfile& profile);

/// Red, green, blue and alpha, 0..65535.
using WidePixel = std::array<std::uint16_t, 4>;
/// The picture in sRGB (RGBA8), opaque: over black where it is transparent.
Texture srgb_over_black(const Image<WidePixel>& picture, const ColourProfile& profile);
/// The same of a picture in sRGB, in place.
void put_over_black(Texture& picture);

}  // namespace handcast::renderer
