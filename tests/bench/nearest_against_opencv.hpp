// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::bench {

/// Medians of interleaved runs on one thread, and pixels given a seed that is not the nearest.
struct NearestComparison {
  double ours_us = 0, opencv_us = 0;
  int wanted = 0, wrong_ours = 0, wrong_opencv = 0;
};

/// A hand that moved 12 px: fill what is uncovered from what is still lit, within 32 px.
/// `whole_frame`: both get all 1024x768 pixels, of which ours looks at those around the wanted ones
/// only; OpenCV labels every pixel and knows no bound. Otherwise both get the region of the hand.
NearestComparison compare_nearest(bool whole_frame, int rounds);

}  // namespace handcast::bench
