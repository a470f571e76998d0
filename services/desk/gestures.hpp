// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// Recognises what hands do. An event needs a clear sign, and the same event only comes again after
/// a clear sign of its end: noise around a threshold makes none.
///
/// Events, each behind "left." or "right.": appears, leaves, pinch, fist, open, point; and touch:
/// the hands touch each other. One thread.
class Gestures {
 public:
  /// `up`: against gravity, in the space of the camera. `meshes`: the drawn hands, left, right, for
  /// the places of joints in the texture.
  Gestures(const glm::mat4& camera_from_tracker, const glm::vec3& up,
           const std::array<renderer::HandMesh, msg::kMaxHands>& meshes);

  /// Uses another direction of up from now on.
  void set_up(const glm::vec3& up) { up_ = glm::normalize(up); }
  /// Adds a tracker sample.
  void push(const msg::HandPoses& poses);
  /// The hands at `now_ns`, CLOCK_MONOTONIC, with the events since the last call.
  const Scene& at(std::int64_t now_ns);

 private:
  /// A sign that is on beyond one number, and off beyond another.
  struct Latch {
    bool is_on = false;
    /// True if it goes on now.
    bool rises(float value, float on, float off);
  };
  struct Memory {
    std::int64_t seen_ns = 0, since_ns = 0;  ///< the newest sample; the first one without a gap
    glm::vec3 palm_m{0};
    Latch pinch, fist, open, point;
  };

  void see(const msg::HandPose& pose, std::int64_t origin_ns);
  void recognise(std::size_t hand);
  void touch();
  void note(std::size_t hand, const char* event);

  glm::mat4 camera_from_tracker_;
  glm::vec3 up_;
  std::array<Memory, msg::kMaxHands> memories_;
  Latch touching_;
  Scene scene_;
  std::vector<std::string> noted_;  ///< events since the last at()
};

}  // namespace handcast::desk
