// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/predict/hand_sides.hpp"
#include "renderer/predict/pose_history.hpp"
#include "renderer/skin/bone_fit.hpp"
#include "services/content/source.hpp"

namespace handcast::content {

/// Left and right.
using BothHands = std::array<HandState, 2>;

/// Fills what HandState derives from its side and its joints (renderer::posture_of(),
/// renderer::palm_axes()).
///
/// - palm_normal: at right angles to the palm's axis, from the wrist to the mean of the knuckles,
///   and to the line from the knuckle of the little finger to that of the index finger.
/// - gravity: `down` (camera space, not zero) in the axes of the palm.
void derive(HandState& hand, const glm::vec3& down);

/// What content knows about the hands of a rig at a time. One thread.
class Hands {
 public:
  /// Loads the meshes of the rig. Errors: those of renderer::load_hand_or_default().
  static Result<Hands> load(const config::Rig& rig, const calib::Calibration& calibration);
  /// With the meshes of the left and of the right hand. Copies its arguments.
  Hands(std::array<renderer::HandMesh, 2> meshes, const config::Rig& rig,
        const calib::Calibration& calibration);

  /// Uses other settings from now on.
  void adjust(const config::Rig& rig);

  /// Adds a tracker sample. One that claims to be from the future is ignored, as is a hand of low
  /// confidence; exchanged sides are corrected as the projector does.
  void push(const msg::HandPoses& poses);

  /// The hands at a time, CLOCK_MONOTONIC: predicted as the projector does (cascade.predict),
  /// without the corrections by landmarks. A hand whose newest sample is more than 0.2 s older is
  /// not there: it is held up 0.7 m in front of the camera with its back to it. The surfaces are
  /// valid until the next call.
  BothHands at(std::int64_t time_ns) { return both_at(time_ns, shown_); }
  /// The same, with surfaces of their own: for the time of a camera image.
  BothHands seen_at(std::int64_t time_ns) { return both_at(time_ns, seen_); }

  /// Whether at() and seen_at() fill HandState::positions_m and normals, which takes most of their
  /// time. Off at first.
  void needs_surface(bool needed) { has_surface_ = needed; }

  /// The meshes of the left and the right hand; valid as long as this object.
  std::array<const renderer::HandMesh*, 2> meshes() const {
    return {&hands_[0].mesh, &hands_[1].mesh};
  }

 private:
  struct Surface {
    std::vector<glm::vec3> positions_m, normals;
  };
  struct Hand {
    renderer::HandMesh mesh;
    renderer::PoseHistory history;
    renderer::BoneFit bone_fit;
  };

  BothHands both_at(std::int64_t time_ns, std::array<Surface, 2>& surfaces);
  HandState resting(const Hand& hand) const;
  HandState posed(const Hand& hand, const msg::HandPose& pose, Surface& surface) const;
  glm::vec3 velocity_m_s(const Hand& hand, std::int64_t time_ns) const;

  config::Skin skin_;
  glm::vec3 down_;
  glm::mat4 camera_from_tracker_;
  std::vector<Hand> hands_;
  renderer::HandSides sides_;
  bool has_surface_ = false;
  std::array<Surface, 2> shown_, seen_;
};

}  // namespace handcast::content
