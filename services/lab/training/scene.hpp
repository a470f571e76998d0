// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/training/light.hpp"
#include "services/lab/training/view.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {

/// Lit hands with their forearms and sleeves, drawn directly into the crop. Keeps its buffers; one
/// thread.
class Scene {
 public:
  static constexpr int kFine = 2;  ///< samples along a side of a crop pixel

  /// An empty scene.
  Scene(const calib::CameraModel& camera, const Region& region);

  /// Removes all hands; the crop shows `region` now.
  void clear(const Region& region);
  /// Adds a hand with its forearm. `in_camera`: its joints in camera axes (metres).
  void add_hand(Dice& dice, const Person& person, const renderer::JointFrames& in_camera,
                const Light& light);
  /// Draws all hands, with shadows in some images.
  void draw(Dice& dice, const Light& light);

  /// The light of hands and arms in each pixel, kSide_px x kSide_px; valid until the next draw().
  const std::vector<float>& grey() const { return grey_; }
  /// The fraction of each pixel that hands and arms cover, 0..1.
  const std::vector<float>& cover() const { return cover_; }
  /// True if a point of the first hand (camera axes, metres) is visible in the crop. Flesh within
  /// `radius_m` in front of it does not hide it.
  bool sees(const glm::vec3& place_m, float radius_m) const;

 private:
  struct Shot {
    Surface surface;
    const std::vector<std::array<std::uint16_t, 3>>* triangles = nullptr;
    std::vector<float> grey;
    twin::ScreenVertices screen;
    twin::Forearm arm;  ///< `triangles` may point into it
    bool is_arm = false;
  };
  Shot& next_shot();
  void add_arm(Dice& dice, const Person& person, const glm::mat4& camera_from_arm, float tone,
               const Light& light);
  glm::vec2 fine_px(const glm::vec3& place_m) const;
  void cast_shadows(const Light& light, float depth);
  void gather();

  calib::CameraModel camera_;
  glm::mat2 fine_from_image_{1};
  glm::vec2 fine_origin_{0};
  std::deque<Shot> shots_;  ///< a deque, because a shot may point into itself
  std::size_t shot_count_ = 0;
  renderer::Image<float> inverse_depth_, fine_, shadow_depth_;
  std::vector<float> grey_, cover_;
};

}  // namespace handcast::landmarks::training
