// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Fits the skeleton of a mesh to the joints of another person before linear blend skinning. Each
/// bone is aimed at the next joint, stretched to reach it, and widened by the ratio of the sizes of
/// the hands. Otherwise a bone of another length or position than the mesh's would move rigidly
/// with its joint and leave a step at the next one. Rotations about the axis of a bone are kept;
/// tips are not changed.
///
/// The palm is treated separately: trackers only guess the bases of the metacarpals and no landmark
/// shows them, but a palm is nearly rigid. Its bases and knuckles, relative to the wrist, are
/// learned as a mean over some seconds. A sample changes that palm only as far as its wrist and
/// knuckles differ from the mean. The size of the hand is learned in the same way. One thread.
class BoneFit {
 public:
  /// For the skeleton of `hand` at rest. Nothing is learned yet.
  explicit BoneFit(const HandMesh& hand) : rest_(hand.rest) {}

  /// Adds a tracker sample; one that is not finite is ignored. After more than a second without
  /// samples the person is learned anew.
  void learn(std::int64_t origin_ns, const JointFrames& posed);

  /// Multiplies the fingers' widths by `factor` from now on, and the palm's by half as much: its
  /// breadth and theirs go together, but not wholly.
  void widen(float factor) { width_ = factor; }

  /// The frames to skin with, in the space of `posed`. Their scale is not 1 in general.
  JointFrames operator()(const JointFrames& posed) const;

 private:
  /// The proportions of one person's hand.
  struct Person {
    std::array<glm::vec3, 4> base{}, knuckle{};  ///< index to little finger, in wrist space
    float size = 1;                              ///< relative to the mesh
  };
  Person person_in(const JointFrames& posed) const;

  JointFrames rest_;
  Person person_;
  float width_ = 1;
  int learned_ = 0;  ///< samples in the mean
  std::int64_t last_ns_ = 0;
};

}  // namespace handcast::renderer
