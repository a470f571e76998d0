// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/landmarks/training/dice.hpp"
#include "services/landmarks/training/sample.hpp"

namespace handcast::landmarks::training {

/// What happens to a crop between the scene and the network: what lies behind, light of the
/// projector, the lens, the sensor. All images are kSide_px squared. Keeps buffers; one thread.
class Film {
 public:
  Film();

  void begin(const std::vector<float>& grey, const std::vector<float>& cover);
  void texture(Dice& dice);     ///< skin finer than the mesh
  void background(Dice& dice);  ///< a wall, things on it
  void leak(Dice& dice);        ///< the projector's picture, faintly, on hand and wall
  void cover(Dice& dice);       ///< something dark in front of a part
  void blur(Dice& dice);        ///< out of focus, moving
  void develop(Dice& dice, std::vector<std::uint8_t>& pixels);  ///< gain, saturation, noise, 8 bit

 private:
  void blend_waves(Dice& dice, int cells, float strength, std::vector<float>& image);
  void add_thing(Dice& dice);
  void blur_across(float sigma_px);
  void smear(float length_px, float angle_rad);

  std::vector<float> image_, cover_, wall_, other_, knots_;
};

}  // namespace handcast::landmarks::training
