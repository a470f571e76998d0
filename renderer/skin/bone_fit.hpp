// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Makes linear blend skinning follow the joints of another person: each bone is aimed at the next
/// joint, stretched to reach it, and widened by how much larger this hand is than the mesh. Without
/// this a bone that is longer, shorter or elsewhere than the mesh's moves stiffly with its joint
/// and meets the next one with a step. The palm is a case of its own: trackers only guess at the
/// bases of the metacarpals and no landmark shows them, but a palm is nearly rigid. Its bases and
/// knuckles as seen from the wrist are learned as a mean over some seconds, and what a sample says
/// against that mean only bends the palm as far as wrist and knuckles show it. The width is learned
/// likewise. Turns about a bone's own axis are kept; tips are left alone.
class BoneFit {
 public:
  explicit BoneFit(const HandMesh& hand) : rest_(hand.rest) {}

  /// A tracker sample; one that is not finite is ignored. The person is learned afresh after the
  /// hand was gone for a second.
  void learn(std::int64_t origin_ns, const JointFrames& posed);

  /// Draws every width times `factor` from now on.
  void widen(float factor) { width_ = factor; }

  /// The frames to skin with.
  JointFrames operator()(const JointFrames& posed) const;

 private:
  /// What stays the same as long as one person's hand is in sight.
  struct Person {
    std::array<glm::vec3, 4> base{}, knuckle{};  ///< index to little finger, as seen from the wrist
    float size = 1;                              ///< times the mesh's
  };
  Person person_in(const JointFrames& posed) const;

  JointFrames rest_;
  Person person_;
  float width_ = 1;
  int learned_ = 0;  ///< samples in the mean
  std::int64_t last_ns_ = 0;
};

}  // namespace handcast::renderer
