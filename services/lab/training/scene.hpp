// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/training/dice.hpp"
#include "services/lab/training/pose.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"
#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {

/// The vertices of a surface.
struct Surface {
  /// Positions (metres) and normals in camera axes.
  /// @{
  std::vector<glm::vec3> positions, normals;
  /// @}
  std::vector<float> albedo;  ///< the fraction of the light that each vertex reflects
};

/// An infrared lamp beside the lens, and how skin reflects it.
class Light {
 public:
  /// Draws a lamp for a hand at `hand_m` (camera axes, metres).
  Light(Dice& dice, const glm::vec3& hand_m);

  /// Sets the grey value of each vertex, about 1 for bright skin that faces the lamp at the hand's
  /// distance.
  void shade(const Surface& surface, std::vector<float>& grey) const;
  /// The position of the lamp in camera axes.
  const glm::vec3& lamp_m() const { return lamp_m_; }

 private:
  glm::vec3 lamp_m_;
  float distance_m_;
  float falloff_;  ///< exponent of 1/distance
  float wrap_;     ///< how far light reaches surfaces that face away: scattering under the skin
  float contrast_;
  float gloss_;
  glm::vec2 spot_m_;  ///< centre of the beam at the hand's distance
  float beam_m_;      ///< its width there; 0: the light is uniform
  float plane_m_;
};

/// Darkens vertices by ambient occlusion; the occluders are spheres around `balls`, the centres of
/// the hand's parts.
void occlude(const Surface& surface, std::span<const glm::vec3> balls, float strength,
             std::vector<float>& grey);

/// Draws a position of the wrist in camera axes (metres): any side of the hand faces the camera,
/// its centre is in view.
glm::mat4 draw_view(Dice& dice, const renderer::JointFrames& joints);

/// All joints transformed by `m`.
renderer::JointFrames moved(const glm::mat4& m, const renderer::JointFrames& joints);

/// The joints of the 21 landmarks in camera pixels. `in_camera`: in camera axes (metres).
Points project(const calib::CameraModel& camera, const renderer::JointFrames& in_camera);

/// Draws a tracker's joints for this hand, in camera pixels: with errors in size, position and
/// pose; in one image of five in another pose. `definitions`: where it has its joints.
Points draw_tracker(Dice& dice, const calib::CameraModel& camera, const std::vector<Person>& people,
                    const Person& person, const Pose& pose, const renderer::JointFrames& in_camera,
                    const Definitions& definitions);

/// Draws the region that a detector would use: around the landmarks of the image before, or around
/// the tracker's joints. `tracker_px`: null if there is no tracker.
Region draw_region(Dice& dice, const Points& truth_px, const Points* tracker_px);
/// Draws a region beyond the wrist of a hand, in which none of its fingers is: where a detector
/// without a tracker may look for a hand, too.
Region draw_arm_region(Dice& dice, const Points& hand_px);

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
  void add_arm(Dice& dice, const renderer::HandMesh& hand, const glm::mat4& camera_from_arm,
               float tone, const Light& light);
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
