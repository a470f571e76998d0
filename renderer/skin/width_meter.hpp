// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// How much wider a person's fingers are than the drawn ones, learned from the camera's mask:
/// across the middle of every finger bone that is seen from the side, the mask is as wide as the
/// finger. (The shape of the hand is the paper's stated limitation.) The factor is the lower third
/// of the bones' medians over the last seconds: neither a bone that another one touches now and
/// then nor two that touch for long do harm. It is learned afresh after nothing was measured for a
/// second, and held until then: the light must not jump.
class WidthMeter {
 public:
  explicit WidthMeter(const HandMesh& mesh);

  /// One frame as drawn with factor(): where the vertices and the landmarks land after every
  /// correction, and the mask of the hand at the same time, all in projector px.
  void measure(std::int64_t time_ns, std::span<const glm::vec2> landings_px,
               const LandmarkPoints& landmarks_px, GreyView mask);

  /// For the widths of the next frame; 1 until enough was seen, never beyond 0.75..1.35.
  float factor() const { return factor_; }

 private:
  /// A finger bone from one landmark to the next, and the edges of the mesh around it that may
  /// cross its middle.
  struct Bone {
    int landmark = 0;  ///< it ends at the following one
    std::vector<std::array<std::uint16_t, 2>> edges;
    std::array<int, 256>
        seen{};  ///< histogram of the factors seen; halved when it is full, so that old ones fade
    int count = 0;

    void note(float factor);
    float median() const;
  };
  /// How wide the mask is at a bone against how wide the bone is drawn; nothing where that cannot
  /// be seen.
  std::optional<float> ratio_at(const Bone& bone, std::span<const glm::vec2> landings_px,
                                const LandmarkPoints& landmarks_px, GreyView mask) const;
  void forget();
  std::optional<float> typical() const;

  std::vector<Bone> bones_;
  float factor_ = 1;
  std::int64_t last_ns_ = 0;
  LandmarkPoints last_px_{};
};

}  // namespace handcast::renderer
