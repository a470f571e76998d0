// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "services/tools/preview/canvas/canvas.hpp"
#include "services/tools/preview/layout/gauges.hpp"
#include "services/tools/preview/layout/layer.hpp"
#include "services/tools/preview/scene/scene.hpp"

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
