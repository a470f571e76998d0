// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "services/lab/hand_maker/glove_layout.hpp"

namespace handcast::renderer {

using namespace glove;

GloveTemplate::GloveTemplate() {
  add_palm();
  for (int f = 0; f < kFingers; ++f) add_finger(f);
  find_seam();
  glue();
}

int GloveTemplate::finger_vertex(int finger, int column, int row) const {
  if (row > 0) return finger_[finger][(row - 1) * (kHalfRing + 1) + column];
  if (finger == 0) return palm_vertex(0, kThumbRow + column);
  return palm_vertex((finger - 1) * (kHalfRing + kWebQuads) + column, kPalmRows);
}

void GloveTemplate::add_palm() {
  for (int row = 0; row <= kPalmRows; ++row)
    for (int column = 0; column <= kPalmColumns; ++column) {
      palm_.push_back(sheet_count());
      sheet_.push_back({-1, column, row});
    }
  for (int j = 0; j < kPalmRows; ++j)
    for (int i = 0; i < kPalmColumns; ++i)
      quads_.push_back({palm_vertex(i, j), palm_vertex(i + 1, j), palm_vertex(i + 1, j + 1),
                        palm_vertex(i, j + 1)});
}

void GloveTemplate::add_finger(int finger) {
  for (int row = 1; row <= kFingerRows[finger]; ++row)
    for (int column = 0; column <= kHalfRing; ++column) {
      finger_[finger].push_back(sheet_count());
      sheet_.push_back({finger, column, row});
    }
  for (int j = 0; j < kFingerRows[finger]; ++j)
    for (int i = 0; i < kHalfRing; ++i)
      quads_.push_back({finger_vertex(finger, i, j), finger_vertex(finger, i + 1, j),
                        finger_vertex(finger, i + 1, j + 1), finger_vertex(finger, i, j + 1)});
}

/// The seam consists of the edges of only one quad. A vertex of a quad between two such edges is a
/// corner.
void GloveTemplate::find_seam() {
  std::map<Edge, int> uses;
  const auto edge = [](const Quad& q, int k) { return Edge(std::minmax(q[k], q[(k + 1) % 4])); };
  for (const Quad& q : quads_)
    for (int k = 0; k < 4; ++k) ++uses[edge(q, k)];
  seam_.assign(sheet_.size(), 0);
  for (const auto& [e, count] : uses) {
    sheet_edges_.push_back(e);
    if (count == 1) {
      seam_edges_.push_back(e);
      seam_[e.first] = seam_[e.second] = 1;
    }
  }
  for (const Quad& q : quads_) {
    int corner = -1;
    for (int k = 0; k < 4; ++k)
      if (uses[edge(q, k)] == 1 && uses[edge(q, (k + 3) % 4)] == 1) corner = k;
    corner_.push_back(corner);
  }
}

void GloveTemplate::glue() {
  for (int v = 0; v < sheet_count(); ++v) {
    palmar_.push_back(seam_[v] ? v : sheet_count() + static_cast<int>(palm_inner_.size()));
    if (!seam_[v]) palm_inner_.push_back(v);
  }
  glued_count_ = sheet_count() + static_cast<int>(palm_inner_.size());
  glued_edges_ = sheet_edges_;
  for (const auto& [a, b] : sheet_edges_)
    glued_edges_.push_back(std::minmax(palmar_[a], palmar_[b]));
  std::sort(glued_edges_.begin(), glued_edges_.end());
  glued_edges_.erase(std::unique(glued_edges_.begin(), glued_edges_.end()), glued_edges_.end());
}

std::vector<Triangle> GloveTemplate::triangulated(const std::vector<glm::dvec3>& glued_positions,
                                                  bool back) const {
  const auto place = [&](int sheet_vertex) {
    return glued_positions[back ? sheet_vertex : palmar_[sheet_vertex]];
  };
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < quads_.size(); ++k) {
    const auto& [a, b, c, d] = quads_[k];
    const bool a_to_c =
        corner_[k] >= 0 ? corner_[k] % 2 == 0
                        : glm::distance(place(a), place(c)) <= glm::distance(place(b), place(d));
    if (a_to_c)
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    else
      triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
  }
  if (back)
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return triangles;
}

}  // namespace handcast::renderer
