// SPDX-License-Identifier: Apache-2.0
#include "services/content/blend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "renderer/base/clones.hpp"

namespace handcast::content {
namespace {

using U32 = std::uint32_t;

/// n / 255, rounded to the nearest, of n up to 255 * 255.
inline U32 over_255(U32 n) { return (n + 128 + ((n + 128) >> 8)) >> 8; }

struct Screen {
  U32 operator()(U32 s, U32 d, U32, U32) const { return s + d - over_255(s * d); }
};

/// Blends all pixels of a row: their colours by `of_level` (s, d, as, ab), their alphas by
/// `of_alpha`.
template <class OfLevel, class OfAlpha = Screen>
[[gnu::always_inline]] inline void lay(const U32* below, const U32* above, U32* out,
                                       std::size_t count, U32 opacity, OfLevel of_level,
                                       OfAlpha of_alpha = {}) {
  for (std::size_t i = 0; i < count; ++i) {
    const U32 pixel = above[i], under = below[i];
    const U32 as = over_255((pixel >> 24) * opacity), ab = under >> 24;
    U32 blended = std::min(of_alpha(as, ab, as, ab), U32{255}) << 24;
    for (int shift = 0; shift < 24; shift += 8) {
      const U32 s = over_255((pixel >> shift & 255) * opacity), d = under >> shift & 255;
      blended |= std::min(of_level(s, d, as, ab), U32{255}) << shift;
    }
    out[i] = blended;
  }
}

HANDCAST_CLONES void lay_row(const U32* below, const U32* above, U32* out, std::size_t count,
                             U32 opacity, Blend how) {
  const auto over = [](U32 s, U32 d, U32 as, U32) { return s + over_255(d * (255 - as)); };
  const auto add = [](U32 s, U32 d, U32, U32) { return s + d; };
  const auto multiply = [](U32 s, U32 d, U32 as, U32 ab) {
    return over_255(s * d + s * (255 - ab) + d * (255 - as));
  };
  const auto lighten = [](U32 s, U32 d, U32 as, U32 ab) {
    return over_255(std::max(s * ab, d * as) + s * (255 - ab) + d * (255 - as));
  };
  const auto darken = [](U32 s, U32 d, U32 as, U32 ab) {
    return over_255(std::min(s * ab, d * as) + s * (255 - ab) + d * (255 - as));
  };
  const auto difference = [](U32 s, U32 d, U32 as, U32 ab) {
    return over_255(255 * (s + d) - 2 * std::min(s * ab, d * as));
  };
  switch (how) {
    case Blend::over:
      return lay(below, above, out, count, opacity, over);
    case Blend::add:
      return lay(below, above, out, count, opacity, add, add);
    case Blend::multiply:
      return lay(below, above, out, count, opacity, multiply);
    case Blend::screen:
      return lay(below, above, out, count, opacity, Screen());
    case Blend::lighten:
      return lay(below, above, out, count, opacity, lighten);
    case Blend::darken:
      return lay(below, above, out, count, opacity, darken);
    case Blend::difference:
      return lay(below, above, out, count, opacity, difference);
  }
}

HANDCAST_CLONES void mix_row(const U32* from, const U32* to, U32* out, std::size_t count,
                             U32 part) {
  for (std::size_t i = 0; i < count; ++i) {
    U32 mixed = 0;
    for (int shift = 0; shift < 32; shift += 8)
      mixed |= over_255((from[i] >> shift & 255) * (255 - part) + (to[i] >> shift & 255) * part)
               << shift;
    out[i] = mixed;
  }
}

HANDCAST_CLONES void fade_row(const U32* from, const U32* to, U32* out, std::size_t count,
                              float part) {
  for (std::size_t i = 0; i < count; ++i) {
    U32 faded = 0;
    for (int shift = 0; shift < 32; shift += 8) {
      const auto a = static_cast<int>(from[i] >> shift & 255),
                 b = static_cast<int>(to[i] >> shift & 255);
      const float light = (1 - part) * static_cast<float>(a * a) + part * static_cast<float>(b * b);
      faded |= static_cast<U32>(static_cast<int>(std::sqrt(light) + 0.5f)) << shift;
    }
    out[i] = faded;
  }
}

U32 level_of(double part) { return static_cast<U32>(std::lround(255 * std::clamp(part, 0., 1.))); }

/// Calls `row` for each row of pictures of the same size.
template <class Row>
void for_rows(Pixels below, Pixels above, renderer::Texture& out, Row row) {
  for (int y = 0; y < out.height(); ++y)
    row(below.row(y), above.row(y), out.row(y), static_cast<std::size_t>(out.width()));
}

}  // namespace

std::span<const std::string> blend_names() {
  static const std::array<std::string, 7> kNames{"over",    "add",    "multiply",  "screen",
                                                 "lighten", "darken", "difference"};
  return kNames;
}

void blend(Pixels below, Pixels above, Blend how, double opacity, renderer::Texture& out) {
  for_rows(below, above, out,
           [how, level = level_of(opacity)](auto... row) { lay_row(row..., level, how); });
}

void mix(Pixels from, Pixels to, double part, renderer::Texture& out) {
  for_rows(from, to, out, [level = level_of(part)](auto... row) { mix_row(row..., level); });
}

void fade(Pixels from, Pixels to, double part, renderer::Texture& out) {
  const auto most = static_cast<float>(std::clamp(part, 0., 1.));
  for_rows(from, to, out, [most](auto... row) { fade_row(row..., most); });
}

}  // namespace handcast::content
