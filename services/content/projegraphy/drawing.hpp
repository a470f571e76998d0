// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace handcast::projegraphy {

/// A place on an animal: `t` of the way from one joint to another of its hands (those of the right
/// hand follow the 26 of the left one), and `side` times the root of the animal's area beside that
/// way, clockwise from it in the picture of animals().
struct Spot {
  constexpr Spot(int joint) : a(joint), b(joint) {}
  constexpr Spot(int from, int to, float way, float beside = 0)
      : a(from), b(to), t(way), side(beside) {}
  int a, b;
  float t = 0, side = 0;
};

/// What covers a surface.
enum class Pattern { plain, fur, feathers, scales, plates, patches, stripes, wrinkles, bumps };

/// Something on an animal. Lengths are relative to the root of its area.
struct Mark {
  enum class Kind {
    limb,    ///< from `from` to `to`, half as wide as `r0` and `r1`, with the pattern
    eye,     ///< at `from`, `r0` large
    slit,    ///< the same with the pupil of a cat
    disc,    ///< shiny
    line,    ///< a curve by `by`, `r0` wide
    spiral,  ///< at `from`, `r0` large, of a line
  };
  Kind kind;
  Spot from, to, by;
  float r0 = 0, r1 = 0;
  std::uint32_t colour = 0;  ///< 0xRRGGBB; of an eye, the iris
  Pattern pattern = Pattern::plain;
};

/// How an animal is painted.
struct Drawing {
  std::uint32_t light = 0, dark = 0;  ///< 0xRRGGBB, of the pattern all over
  Pattern pattern = Pattern::plain;
  std::vector<Mark> marks;  ///< in their order, but limbs before all others
};

/// Those of animals(), in their order.
std::span<const Drawing> drawings();

}  // namespace handcast::projegraphy
