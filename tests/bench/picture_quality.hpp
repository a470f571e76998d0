// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace handcast::bench {

/// Two ways to draw the same frames, nearest texels with hard edges and filtered ones, each
/// compared with the mean of 16 drawings that are shifted by quarters of a pixel (16x
/// supersampling by an accumulation buffer; Haeberli and Akeley, SIGGRAPH 1990). The mean is taken
/// in linear light.
struct PictureQuality {
  /// Structural similarity of the levels inside the region of the hand (Wang et al., IEEE TIP 2004,
  /// Gaussian window of 11 px), per frame.
  struct Similarity {
    std::string frame;
    double hard = 0, smooth = 0;
  };
  std::vector<Similarity> similarity;
  /// Flicker of a fine pattern that moves by a fraction of a pixel per frame: RMS of the change
  /// from frame to frame that the reference does not have, in levels.
  double hard_flicker = 0, smooth_flicker = 0;
  std::string error;  ///< where it could not run
};

/// Measures ten frames of built-in motions and the flicker of `flicker_frames` frames.
PictureQuality measure_picture_quality(int flicker_frames);

}  // namespace handcast::bench
