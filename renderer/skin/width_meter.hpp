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

/// Measures how much wider a person's fingers are than the drawn ones, from the camera's mask:
/// across the middle of each middle phalanx that is seen from the side, the mask is as wide as the
/// finger. (The paper names the variation between users as a limitation.) The factor is the median
/// of the bones' medians over the last seconds, so that neither a finger that touches another now
/// and then nor two that touch for long disturb it. After a second without measure() it is learned
/// anew; it is kept until enough is measured again, so the light does not jump. One thread.
class WidthMeter {
 public:
  /// For the fingers of `mesh`.
  explicit WidthMeter(const HandMesh& mesh);

  /// Measures one frame that was drawn with factor(): its vertices and landmarks after all
  /// corrections, and the mask of the hand at the same time, all in projector px.
  void measure(std::int64_t time_ns, std::span<const glm::vec2> projected_px,
               const LandmarkPoints& landmarks_px, GreyView mask);

  /// The factor for the widths of the next frame, 0.93..1.2; 1 until enough is measured. It
  /// changes by at most 0.005 per frame.
  float factor() const { return factor_; }

 private:
  /// A middle phalanx, and the edges of the mesh that may cross its middle.
  struct Bone {
    int landmark = 0;  ///< where the bone starts; it ends at the next landmark
    std::vector<std::array<std::uint16_t, 2>> edges;
    /// Histogram of the measured factors. It is halved when it is full, so old values fade.
    std::array<int, 256> seen{};
    int count = 0;

    void note(float factor);
    float median() const;
  };
  /// The width of the mask at a bone divided by the width of the drawn bone. Empty if it cannot be
  /// measured.
  std::optional<float> ratio_at(const Bone& bone, std::span<const glm::vec2> projected_px,
                                const LandmarkPoints& landmarks_px, GreyView mask) const;
  void forget();
  std::optional<float> typical() const;

  std::vector<Bone> bones_;
  float factor_ = 1;
  std::int64_t last_ns_ = 0;
  LandmarkPoints last_px_{};
};

}  // namespace handcast::renderer
