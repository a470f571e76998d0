// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "services/lab/training/dice.hpp"
#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {

/// One training image in the format of handcast-training-images: little-endian, no padding.
/// generated.py reads it.
struct Sample {
  /// `image` is the network's input plus handcast_network::kShownShift, times this, rounded.
  static constexpr float kUnit = 170;

  handcast_network::Places tracker{};  ///< the tracker's joints; they count if has_tracker is 1
  handcast_network::Places truth{};    ///< the labels; may be outside 0..1
  /// The crop in units of 1 / kUnit, row by row.
  std::array<std::uint8_t, handcast_network::kSide_px * handcast_network::kSide_px> image{};
  std::array<std::uint8_t, msg::kLandmarks> visible{};  ///< 1: only its own flesh hides the joint
  std::uint8_t has_tracker = 0;                         ///< 1: the tracker reports a hand
  std::uint8_t has_hand = 0;                            ///< 1: the image shows a hand
  std::uint8_t reserved = 0;                            ///< padding
};
static_assert(sizeof(Sample) ==
              4 * 42 * 2 + handcast_network::kSide_px * handcast_network::kSide_px + 24);

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
