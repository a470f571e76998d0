// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"
#include "services/evaluation/twin/surface.hpp"
#include "services/landmarks/models/handcast_network.hpp"
#include "services/landmarks/training/light.hpp"
#include "services/landmarks/training/view.hpp"

namespace handcast::landmarks::training {

/// Lit hands with their forearms and sleeves, drawn straight into the crop. Keeps buffers; one
/// thread.
class Scene {
 public:
  static constexpr int kFine = 2;  ///< samples across a pixel of the crop

  Scene(const calib::CameraModel& camera, const Region& region);

  void clear(const Region& region);
  void add_hand(Dice& dice, const Person& person, const renderer::JointFrames& in_camera,
                const Light& light);
  void draw(Dice& dice, const Light& light);

  /// Light from hands and arms, and the share of each pixel they cover. kSide_px squared.
  const std::vector<float>& grey() const { return grey_; }
  const std::vector<float>& cover() const { return cover_; }
  /// Nothing but its own flesh lies before a point of the first hand.
  bool sees(const glm::vec3& place_m, float radius_m) const;

 private:
  struct Shot {
    Surface surface;
    const std::vector<std::array<std::uint16_t, 3>>* triangles = nullptr;
    std::vector<float> grey;
    twin::ScreenVertices screen;
    twin::Forearm arm;  ///< whose triangles they may be
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
  std::deque<Shot> shots_;  ///< a shot may point into itself: it stays where it is
  std::size_t shot_count_ = 0;
  renderer::Image<float> inverse_depth_, fine_, shadow_depth_;
  std::vector<float> grey_, cover_;
};

}  // namespace handcast::landmarks::training
