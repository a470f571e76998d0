// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <utility>
#include <vector>

#include "services/lab/hand_maker/rest_pose.hpp"

namespace handcast::renderer {

/// The quads of one sheet. Column 0 is at the side of the thumb; rows run from the end of the
/// forearm to the fingers.
namespace glove {
inline constexpr int kHalfRing = 6;  ///< quads across the back of a finger; a ring has 12
inline constexpr int kWebQuads = 2;  ///< quads between two fingers
inline constexpr int kPalmColumns = 4 * kHalfRing + 3 * kWebQuads;  ///< quads across the palm
inline constexpr int kForearmRows = 6;               ///< quads from the forearm's end to the wrist
inline constexpr int kPalmRows = kForearmRows + 14;  ///< quads from there to the fingers
inline constexpr int kThumbRow = kForearmRows + 2;   ///< first of the kHalfRing rows of the thumb
/// Quads along each finger.
inline constexpr std::array<int, kFingers> kFingerRows{17, 17, 18, 17, 15};
}  // namespace glove

/// The place of a vertex in the sheet.
struct SheetVertex {
  int finger = -1;  ///< 0..4; -1 in the palm
  int column = 0;   ///< from the side of the thumb
  int row = 0;      ///< of the palm from 0, of a finger from 1
};

using Edge = std::pair<int, int>;     ///< two vertices, the smaller first
using Quad = std::array<int, 4>;      ///< four vertices in cyclic order
using Triangle = std::array<int, 3>;  ///< three vertices

/// The topology of all hands that handcast makes, whatever the person. One flat sheet of quads with
/// the outline of a hand is used twice, for the back and the palm, which are glued along the
/// outline. The outline is the seam of the texture.
///
/// There are three numberings of the vertices. *Sheet* vertices: 0 to sheet_count() - 1. *Glued*
/// vertices: those of the back, with the same numbers, then the inner ones of the palm. *File*
/// vertices: the sheet for the back, then the sheet for the palm.
class GloveTemplate {
 public:
  /// Builds the sheet.
  GloveTemplate();

  /// Number of sheet vertices.
  int sheet_count() const { return static_cast<int>(sheet_.size()); }
  /// Number of glued vertices.
  int glued_count() const { return glued_count_; }
  /// Number of file vertices.
  int file_count() const { return 2 * sheet_count(); }

  /// The sheet vertices.
  const std::vector<SheetVertex>& sheet() const { return sheet_; }
  /// The sheet vertex of the palm at a column (0..kPalmColumns) and a row (0..kPalmRows).
  int palm_vertex(int column, int row) const {
    return palm_[row * (glove::kPalmColumns + 1) + column];
  }
  /// The sheet vertex of a finger at a column (0..kHalfRing) and a row (0..kFingerRows). Row 0 is
  /// part of the palm.
  int finger_vertex(int finger, int column, int row) const;

  /// True if a sheet vertex is on the seam.
  bool on_seam(int sheet_vertex) const { return seam_[sheet_vertex]; }
  /// The glued vertex of a sheet vertex on the palm.
  int glued_on_palm(int sheet_vertex) const { return palmar_[sheet_vertex]; }
  /// The glued vertex of a file vertex.
  int glued_of_file(int file_vertex) const {
    return file_vertex < sheet_count() ? file_vertex : palmar_[file_vertex - sheet_count()];
  }
  /// The sheet vertex of a glued vertex.
  int sheet_of_glued(int glued) const {
    return glued < sheet_count() ? glued : palm_inner_[glued - sheet_count()];
  }
  /// True if a glued vertex is on the back or on the seam.
  bool on_back(int glued) const { return glued < sheet_count(); }

  /// Edges of the quads of the sheet, in sheet vertices.
  const std::vector<Edge>& sheet_edges() const { return sheet_edges_; }
  /// Edges of the seam, in sheet vertices.
  const std::vector<Edge>& seam_edges() const { return seam_edges_; }
  /// Edges of the quads of back and palm, in glued vertices.
  const std::vector<Edge>& glued_edges() const { return glued_edges_; }

  /// Splits the quads of the back or of the palm into triangles of sheet vertices,
  /// counter-clockwise seen from outside. The diagonal is the shorter one, except that it ends in
  /// the corner of a quad with two sides on the outline; otherwise that vertex would have only two
  /// neighbours.
  std::vector<Triangle> triangulated(const std::vector<glm::dvec3>& glued_positions,
                                     bool back) const;

 private:
  void add_palm();
  void add_finger(int finger);
  void find_seam();
  void glue();

  std::vector<SheetVertex> sheet_;
  std::vector<int> palm_;                          ///< (kPalmRows + 1) x (kPalmColumns + 1)
  std::array<std::vector<int>, kFingers> finger_;  ///< rows 1.. x (kHalfRing + 1)
  std::vector<Quad> quads_;
  std::vector<int> corner_;  ///< by quad: its corner between two outline sides, or -1
  std::vector<char> seam_;
  std::vector<int> palmar_, palm_inner_;
  std::vector<Edge> sheet_edges_, seam_edges_, glued_edges_;
  int glued_count_ = 0;
};

/// The position of the sheet inside a person's hand, by sheet vertex. Millimetres.
struct GloveLayout {
  std::vector<glm::dvec3> middle;      ///< a point between back and palm
  std::vector<glm::dvec3> dorsal;      ///< unit vector to the back of the hand or finger
  std::vector<double> half_thickness;  ///< estimated distance from the middle to the skin
};

/// Lays the sheet into the hand of `shape`, whose rest pose must be `rest`.
GloveLayout lay_out_glove(const GloveTemplate& glove, const HandShape& shape, const RestPose& rest);

}  // namespace handcast::renderer
