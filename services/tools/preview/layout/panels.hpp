// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "services/tools/preview/canvas/canvas.hpp"
#include "services/tools/preview/layout/gauges.hpp"
#include "services/tools/preview/layout/layer.hpp"
#include "services/tools/preview/scene/scene.hpp"

namespace handcast::preview::theme {

// Colours, fonts and distances of the preview.

/// Surfaces, lines and text.
/// @{
inline constexpr auto kBackground = Colour::of(0x0d1117), kPanel = Colour::of(0x151b23),
                      kLine = Colour::of(0x2a323d), kInk = Colour::of(0xe6edf3),
                      kQuiet = Colour::of(0x8d96a0);
/// @}
/// Good and bad.
/// @{
inline constexpr auto kGood = Colour::of(0x3fb950), kBad = Colour::of(0xff6b6b);
/// @}
/// The regions A, B, C and D over the image.
inline constexpr std::array<Colour, kRegions> kRegion{
    Colour::of(0x3b82f6, 0.10F), Colour::of(0xff3b6b, 0.75F), Colour::of(0xffb020, 0.75F),
    Colour::of(0x14b8a6, 0.42F)};
/// The tracker's joints, the landmarks, and the edges of the drawing.
/// @{
inline constexpr auto kJoints = Colour::of(0x58a6ff), kLandmarks = Colour::of(0xffffff),
                      kSigma = Colour::of(0xf0c8ff), kDrawing = Colour::of(0xd6fff4, 0.30F);
/// @}
/// The graphs of ages: image, tracker, landmarks.
inline constexpr std::array<Colour, 3> kAges{Colour::of(0x2dd4bf), Colour::of(0x58a6ff),
                                             Colour::of(0xe2a3ff)};
/// Rates and times.
/// @{
inline constexpr auto kRate = Colour::of(0x2dd4bf), kWanted = Colour::of(0x8d96a0),
                      kMedian = Colour::of(0x2dd4bf), kTail = Colour::of(0xffb020);
/// @}

/// Fonts.
/// @{
inline constexpr Font kTitle{.size_px = 12, .bold = true}, kText{.size_px = 12},
    kSmall{.size_px = 11}, kNumber{.size_px = 19, .bold = true}, kHead{.size_px = 16, .bold = true};
/// @}
/// Distance between panels, and inside of them.
/// @{
inline constexpr double kGap_px = 12, kInset_px = 14;
/// @}

}  // namespace handcast::preview::theme

namespace handcast::preview {

/// Draws the background and the title of a panel, with a note on the right side. Returns the box
/// that remains.
Box panel(Canvas& canvas, const Box& box, std::string_view title, std::string_view note = {});
/// The largest box of this aspect ratio in the middle of `box`.
Box fitted(const Box& box, double width, double height);

/// Draws the camera's image and the layers over it, scaled to fill `box`.
void draw_camera(Canvas& canvas, const Box& box, const Scene& scene, const Layers& layers);
/// Draws what the colours mean, with the share of each region, in one or two rows.
void draw_legend(Canvas& canvas, const Box& box, const Scene& scene);
/// Draws one small graph for each stream: its rate over time and the wanted rate.
void draw_rates(Canvas& canvas, const Box& box, const Gauges& gauges);
/// Draws the ages of the inputs of the light over time.
void draw_ages(Canvas& canvas, const Box& box, const Gauges& gauges);
/// Draws the median and the 99th percentile of each stage on a logarithmic scale.
void draw_stages(Canvas& canvas, const Box& box, const Gauges& gauges);

}  // namespace handcast::preview
