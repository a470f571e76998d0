// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <utility>
#include <vector>

#include "renderer/hand/maker/rest_pose.hpp"

namespace handcast::renderer {

/// The quads of one sheet. Column 0 is the thumb's side; rows run from the forearm's end to the
/// fingers.
namespace glove {
inline constexpr int kHalfRing = 6;  ///< quads across a finger's back: a ring of 12 around it
inline constexpr int kWebQuads = 2;  ///< between two fingers
inline constexpr int kPalmColumns = 4 * kHalfRing + 3 * kWebQuads;
inline constexpr int kForearmRows = 6;  ///< from the forearm's end to the wrist
inline constexpr int kPalmRows = kForearmRows + 14;
inline constexpr int kThumbRow =
    kForearmRows + 2;  ///< first of the rows from whose edge the thumb grows
inline constexpr std::array<int, kFingers> kFingerRows{17, 17, 18, 17, 15};
}  // namespace glove

/// Where a vertex of the sheet sits: in the palm (finger -1) or in row 1.. of a finger.
struct SheetVertex {
  int finger = -1;
  int column = 0;
  int row = 0;
};

using Edge = std::pair<int, int>;
using Quad = std::array<int, 4>;
using Triangle = std::array<int, 3>;

/// The topology of every hand handcast makes: one flat quad sheet of the outline, taken twice (back
/// and palm) and glued along the outline, which so becomes the seam of the texture. It depends on
/// no person.
///
/// Two numberings: *sheet* vertices 0..sheet_count-1; *glued* vertices, the back's first (the same
/// numbers), then the inner ones of the palm. Files hold the sheet twice: *file* vertex v <
/// sheet_count is on the back, v - sheet_count on the palm.
class GloveTemplate {
 public:
  GloveTemplate();

  int sheet_count() const { return static_cast<int>(sheet_.size()); }
  int glued_count() const { return glued_count_; }
  int file_count() const { return 2 * sheet_count(); }

  const std::vector<SheetVertex>& sheet() const { return sheet_; }
  int palm_vertex(int column, int row) const {
    return palm_[row * (glove::kPalmColumns + 1) + column];
  }
  int finger_vertex(int finger, int column, int row) const;

  bool on_seam(int sheet_vertex) const { return seam_[sheet_vertex]; }
  int glued_on_palm(int sheet_vertex) const { return palmar_[sheet_vertex]; }
  int glued_of_file(int file_vertex) const {
    return file_vertex < sheet_count() ? file_vertex : palmar_[file_vertex - sheet_count()];
  }
  int sheet_of_glued(int glued) const {
    return glued < sheet_count() ? glued : palm_inner_[glued - sheet_count()];
  }
  bool on_back(int glued) const { return glued < sheet_count(); }

  const std::vector<Edge>& sheet_edges() const { return sheet_edges_; }
  const std::vector<Edge>& seam_edges() const { return seam_edges_; }
  const std::vector<Edge>& glued_edges() const {
    return glued_edges_;
  }  ///< of the quads of both sheets, without diagonals

  /// Triangles of the sheet as seen by `glued_positions` of the back or of the palm: the shorter
  /// diagonal of each quad, but through the corner where a quad has two sides on the outline (else
  /// that vertex would have two neighbours). Counter-clockwise from outside.
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
  std::vector<int> corner_;  ///< per quad: its corner on two outline sides, or -1
  std::vector<char> seam_;
  std::vector<int> palmar_, palm_inner_;
  std::vector<Edge> sheet_edges_, seam_edges_, glued_edges_;
  int glued_count_ = 0;
};

}  // namespace handcast::renderer
