// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Step "blend": how the light on a hand is shared by two projectors. Each lights what it meets
/// most squarely, and nothing that lies in the shadow of another part of a hand; in between, the
/// shares change gradually, and their sum is 1. Each projector computes both shares from the same
/// hands, so that nothing passes between them. See `docs/method.md#blend`. One thread.
class LightShare {
 public:
  /// One posed hand, by vertex of its mesh. Borrowed for the call of apply().
  struct Hand {
    std::span<const glm::vec3> position_m, normal;  ///< camera space; normals of unit length
    std::span<float> light;                         ///< factor of the levels, 0..1
  };

  /// `calibration.projector` has the light that is drawn, `calibration.projector2`, which must be
  /// there, the other one.
  explicit LightShare(const calib::Calibration& calibration);

  /// Multiplies the light of these hands, which are all that cast a shadow. `beside`: what is on of
  /// the other projector's light, 0..1; the more is missing, the more is drawn here.
  void apply(std::span<const Hand> hands, float beside);

 private:
  /// A projector, and what its light meets first.
  struct Beam {
    explicit Beam(const calib::Calibration& calibration);

    glm::vec3 seen(const glm::vec3& point_m) const;
    void meet(const Hand& hand, std::vector<glm::vec3>& seen);
    float lit_part(const glm::vec3& seen) const;
    float quality(const glm::vec3& seen, const glm::vec3& point_m, const glm::vec3& normal) const;

    glm::mat4x3 projection;     ///< camera space to homogeneous px; the third row is the depth, m
    glm::vec3 centre_m;         ///< in camera space
    float width_px, height_px;  ///< of its image
    int cell_px;                ///< width and height of a cell
    Image<float> nearest_m;     ///< the least depth by cell of its image
  };

  std::array<Beam, 2> beams_;  ///< that of the light that is drawn, and the other one
  /// By hand and beam: px and depth of each vertex.
  std::array<std::array<std::vector<glm::vec3>, 2>, msg::kMaxHands> seen_;
};

}  // namespace handcast::renderer
