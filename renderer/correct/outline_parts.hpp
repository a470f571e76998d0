// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/hand/hand_mesh.hpp"

/// @file
/// What FingerOutline and PalmOutline share: the outline of a mask and of a drawn hand along lines
/// in the image. All points are in projector px.

namespace handcast::renderer {

/// Two vertices of a mesh that are joined by an edge.
using MeshEdge = std::array<std::uint16_t, 2>;

/// The edges of `mesh` between two vertices that are both `among` (one entry per vertex).
std::vector<MeshEdge> edges_among(const HandMesh& mesh, const std::vector<bool>& among);

/// The sum of the weights with which `joints` move a vertex.
float weight_of(const HandMesh& mesh, std::size_t vertex, std::span<const int> joints);

/// A line in the image and a direction that crosses it, both of length 1.
struct Axes {
  glm::vec2 origin{0}, along{0}, across{0};
};

/// Where the drawn surface begins and ends across a line, px from the line.
struct Section {
  float low_px = 1e6f, high_px = -1e6f;

  /// True if nothing is drawn there.
  bool empty() const { return !(high_px > low_px); }
};
/// The section of the drawn edges at `at_px` along the axes from their origin.
Section section_of(std::span<const MeshEdge> edges, std::span<const glm::vec2> vertices_px,
                   const Axes& axes, float at_px);

/// The distance from `start` in direction `way` (unit) to where the mask ends, to a fraction of a
/// pixel. Negative if `start` is outside the mask and the mask begins behind it. Empty if neither
/// is within `most_px`, or the image ends before.
std::optional<float> edge_px(GreyView mask, glm::vec2 start, glm::vec2 way, float most_px);

/// How far a palm faces the camera or turns its back to it: 1; 0: it is seen from its edge.
float frontal_share(const LandmarkPoints& landmarks_px);

/// True if three fingers or more reach clearly beyond the knuckles in the image.
bool is_open(const LandmarkPoints& landmarks_px);

/// The distance of a point from the bone that starts at a landmark and ends at the next one.
float from_bone_px(glm::vec2 place, const LandmarkPoints& landmarks_px, int start, int end);

/// An exponential moving average of a measurement that may be absent, and how much of a full
/// average it is. The caller chooses the time constants.
struct Lasting {
  float value = 0;
  float share = 0;  ///< 0: never measured, or long ago; 1: measured all the time

  /// Adds a measurement that counts as `part` of the average.
  void add(float measured, float part);
  /// Fades while nothing is measured: `kept` of the share remains.
  void fade(float kept) { share *= kept; }
};

}  // namespace handcast::renderer
