// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "renderer/correct/outline_parts.hpp"

namespace handcast::renderer {

/// Moves the fingers of a drawn hand onto the outline of the mask. Landmarks are wrong for longer
/// than a filter may wait, but the mask shows where a finger is: both of its sides across each
/// phalanx, and its end beyond the tip. The difference between mask and drawing is averaged over
/// some hundredths of a second; a Gaussian prior along each finger turns it into displacements of
/// its landmarks. A side is not used if another part of the drawn hand covers or touches it, or if
/// it is far from the drawn one, as where the mask merges with another finger, a second hand, a
/// sleeve or clutter. Only open hands that are not seen from their edge are measured, and of these
/// only the fingers that do not fold back in the image. Without measurements the displacements
/// fade. See
/// `docs/method.md#correct`. One thread.
class FingerOutline {
 public:
  /// For the fingers of `mesh`. Nothing is displaced yet.
  explicit FingerOutline(const HandMesh& mesh);

  /// Measures one frame that was drawn with moved(): its vertices and landmarks after all
  /// corrections, and the mask of the hand at the same time, all in projector px. `vertices_px`:
  /// one per vertex of the mesh.
  void measure(std::int64_t time_ns, std::span<const glm::vec2> vertices_px,
               const LandmarkPoints& landmarks_px, GreyView mask);

  /// The landmarks (projector px), displaced by what was measured.
  LandmarkPoints moved(const LandmarkPoints& landmarks_px) const;

 private:
  static constexpr int kMostBones = 3;

  /// A phalanx that is measured.
  struct Bone {
    int first = 0;  ///< where it starts among the landmarks of its finger; it ends at the next
    float station = 0.5f;         ///< where it is measured, as a share of its length
    std::vector<MeshEdge> edges;  ///< those that may cross it there
    Lasting across_px;            ///< the mask's middle from the drawn one without displacement
  };
  struct Finger {
    int landmark = 0;  ///< its first one
    std::vector<Bone> bones;
    std::vector<std::uint16_t> tip;  ///< vertices of the last phalanx
    Lasting along_px;                ///< the mask's end from the drawn one without displacement
    /// Displacements of its landmarks, across the finger and along it.
    std::array<float, kLandmarksOfFinger> across{}, along{};
  };
  /// A phalanx as it is drawn: the axes begin at the middle of its section, along to the tip.
  struct Drawn {
    Axes axes;
    float half_px = 0;  ///< half of its width
  };
  using DrawnFingers = std::array<std::array<std::optional<Drawn>, kMostBones>, kFingers>;

  static bool is_straight(const Finger& finger, const LandmarkPoints& landmarks_px);
  static std::optional<Drawn> drawn(const Finger& finger, const Bone& bone,
                                    std::span<const glm::vec2> vertices_px,
                                    const LandmarkPoints& landmarks_px);
  DrawnFingers look(std::span<const glm::vec2> vertices_px, const LandmarkPoints& landmarks_px);
  std::optional<float> across(const Finger& finger, const Bone& bone, const Drawn& drawn,
                              const LandmarkPoints& landmarks_px, GreyView mask) const;
  std::optional<float> along(const Finger& finger, const Drawn& drawn,
                             std::span<const glm::vec2> vertices_px,
                             const LandmarkPoints& landmarks_px, GreyView mask) const;
  bool is_free(glm::vec2 place, int landmark, const LandmarkPoints& landmarks_px) const;
  void add(const std::optional<float>& seen_px, float moved_by_px, float part,
           Lasting& average) const;
  void solve_across(Finger& finger) const;
  void solve_along(Finger& finger) const;

  std::array<Finger, kFingers> fingers_;
  std::int64_t last_ns_ = 0;
  LandmarkPoints last_px_{};
  float radius_px_ = 0;  ///< half of the width of a drawn finger, the mean of those seen
};

}  // namespace handcast::renderer
