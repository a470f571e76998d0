// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "renderer/base/image.hpp"

namespace handcast::content {

/// How a picture is laid over another one. With the premultiplied values of both, s = as cs above
/// and d = ab cb below, the result is (W3C, "Compositing and Blending Level 1", 5.1, 9.1)
///
///     over        s + d (1 - as)
///     add         s + d, at most 1
///     multiply    s d + s (1 - ab) + d (1 - as)
///     screen      s + d - s d
///     lighten     max(s ab, d as) + s (1 - ab) + d (1 - as)
///     darken      min(s ab, d as) + s (1 - ab) + d (1 - as)
///     difference  s + d - 2 min(s ab, d as)
///
/// and its alpha as + ab - as ab; of add, as + ab, at most 1. Opacity multiplies s and as before.
/// Values are levels of sRGB, as in browsers and programs that paint, rounded to the nearest.
enum class Blend { over, add, multiply, screen, lighten, darken, difference };

/// The names of all, in the order of Blend.
std::span<const std::string> blend_names();

/// Pictures of the same size, RGBA8 premultiplied. `out` may be `below`.
/// @{
using Pixels = renderer::View<const std::uint32_t>;
/// Lays `above` over `below`. Opacity: 0..1.
void blend(Pixels below, Pixels above, Blend how, double opacity, renderer::Texture& out);
/// (1 - part) * from + part * to, of levels.
void mix(Pixels from, Pixels to, double part, renderer::Texture& out);
/// The same of light, which is taken for the square of the level (sRGB's is the 2.2nd to 2.4th
/// power): a fade has the same speed from dark to bright as from bright to dark. Alpha is mixed in
/// the same way, so that no colour is larger than it.
void fade(Pixels from, Pixels to, double part, renderer::Texture& out);
/// @}

}  // namespace handcast::content
