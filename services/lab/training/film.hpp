// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/lab/training/dice.hpp"
#include "services/lab/training/sample.hpp"

namespace handcast::landmarks::training {

/// Turns the light of a scene into the pixels of a camera: background, light of the projector, lens
/// and sensor. Each step changes the image of the last begin(). All images have kSide_px x kSide_px
/// pixels (handcast_network.hpp). Keeps its buffers; one thread.
class Film {
 public:
  Film();

  /// Starts with a scene's light and the fraction of each pixel that it covers, 0..1.
  void begin(const std::vector<float>& grey, const std::vector<float>& cover);
  /// Adds a skin texture finer than the mesh.
  void texture(Dice& dice);
  /// Adds a wall, and objects on it, behind the scene.
  void background(Dice& dice);
  /// Adds the projector's picture, faintly, to hand and wall.
  void leak(Dice& dice);
  /// Puts something dark in front of a part of the image.
  void cover(Dice& dice);
  /// Adds defocus and motion blur.
  void blur(Dice& dice);
  /// Applies gain, noise and saturation and writes 8-bit pixels.
  void develop(Dice& dice, std::vector<std::uint8_t>& pixels);

 private:
  void blend_waves(Dice& dice, int cells, float strength, std::vector<float>& image);
  void add_thing(Dice& dice);
  void blur_across(float sigma_px);
  void smear(float length_px, float angle_rad);

  std::vector<float> image_, cover_, wall_, other_, knots_;
};

}  // namespace handcast::landmarks::training
