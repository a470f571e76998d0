// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/glove_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/lab/hand_maker/rest_pose.hpp"

namespace handcast::renderer {
namespace {

/// The polyline through a finger's joints, from the MCP joint (thumb: the CMC joint) to the tip,
/// with axes that turn smoothly. Positions on it are given by their arc length from its start.
class FingerAxis {
 public:
  /// Copies the joints of one finger.
  FingerAxis(const RestPose& rest, int finger);

  /// Arc length of the tip.
  double length_mm() const { return arc_mm_[kBones]; }
  /// Arc length of joint `k`, 0..3.
  double joint_mm(int k) const { return arc_mm_[k]; }
  /// The point at an arc length, which is clamped to the ends.
  glm::dvec3 point(double arc_mm) const;
  /// The axes at an arc length. Columns as in RestPose.
  glm::dmat3 axes(double arc_mm) const;
  /// The radius of the finger at an arc length, interpolated between its joints.
  double radius_mm(const HandShape& shape, double arc_mm) const;

 private:
  static constexpr int kBones = 3;
  std::size_t bone_at(double arc_mm) const;

  int finger_;
  std::array<glm::dvec3, kBones + 1> joint_;
  std::array<glm::dmat3, kBones> axes_;
  std::array<double, kBones + 1> arc_mm_{};
};

FingerAxis::FingerAxis(const RestPose& rest, int finger) : finger_(finger) {
  const int first = tip_of(finger) - kBones;
  for (int k = 0; k <= kBones; ++k) joint_[k] = rest.position_mm[first + k];
  for (int k = 0; k < kBones; ++k) {
    axes_[k] = rest.axes[first + k];
    arc_mm_[k + 1] = arc_mm_[k] + glm::distance(joint_[k], joint_[k + 1]);
  }
}

std::size_t FingerAxis::bone_at(double arc_mm) const {
  std::size_t bone = 0;
  while (bone + 1 < kBones && arc_mm >= arc_mm_[bone + 1]) ++bone;
  return bone;
}

glm::dvec3 FingerAxis::point(double arc_mm) const {
  const std::size_t k = bone_at(arc_mm);
  const double share =
      (std::clamp(arc_mm, 0.0, length_mm()) - arc_mm_[k]) / (arc_mm_[k + 1] - arc_mm_[k]);
  return glm::mix(joint_[k], joint_[k + 1], share);
}

glm::dmat3 FingerAxis::axes(double arc_mm) const {
  constexpr double kReach = 5;  // mm: decay of a bone's weight beyond its ends
  glm::dmat3 sum(0);
  for (int k = 0; k < kBones; ++k) {
    const double beyond = std::max({0.0, arc_mm_[k] - arc_mm, arc_mm - arc_mm_[k + 1]}) / kReach;
    sum += axes_[k] * std::exp(-beyond * beyond);
  }
  const glm::dvec3 proximal = glm::normalize(sum[2]);
  const glm::dvec3 lateral = glm::normalize(sum[0] - proximal * glm::dot(sum[0], proximal));
  return {lateral, glm::cross(proximal, lateral), proximal};
}

double FingerAxis::radius_mm(const HandShape& shape, double arc_mm) const {
  const std::size_t k = bone_at(arc_mm);
  const double share = std::clamp((arc_mm - arc_mm_[k]) / (arc_mm_[k + 1] - arc_mm_[k]), 0.0, 1.0);
  return std::lerp(double(shape.radius_mm[finger_][k]), double(shape.radius_mm[finger_][k + 1]),
                   share);
}

using namespace glove;

constexpr double kPi = std::numbers::pi;
/// Position of a finger's first row, as a share of its first bone (thumb: of the metacarpal).
constexpr double kFingerStart = 0.41, kThumbStart = 0.72;

using PalmRow = std::array<glm::dvec3, kPalmColumns + 1>;

/// Linear interpolation of `values` at ascending `knots`, constant beyond the ends.
template <class Value>
Value interpolate(const std::vector<double>& knots, const std::vector<Value>& values, double x) {
  if (x <= knots.front()) return values.front();
  for (std::size_t k = 1; k < knots.size(); ++k)
    if (x <= knots[k])
      return values[k - 1] +
             (values[k] - values[k - 1]) * ((x - knots[k - 1]) / (knots[k] - knots[k - 1]));
  return values.back();
}

class LayoutBuilder {
 public:
  LayoutBuilder(const GloveTemplate& glove, const HandShape& shape, const RestPose& rest)
      : glove_(glove), shape_(shape), rest_(rest) {
    const std::size_t count = glove.sheet().size();
    out_.middle.resize(count);
    out_.dorsal.assign(count, {0, 1, 0});
    out_.half_thickness.assign(count, 8);
  }

  GloveLayout build() && {
    lay_palm_rows();
    lay_thumb_side();
    smooth_palm();
    for (int f = 0; f < kFingers; ++f) lay_finger(f);
    turn_thumb_root();
    return std::move(out_);
  }

 private:
  glm::dvec3& palm(int column, int row) { return out_.middle[glove_.palm_vertex(column, row)]; }
  static int first_column(int finger) { return (finger - 1) * (kHalfRing + kWebQuads); }

  /// The row where the fingers join the palm: half rings, and webs between them that sag by 2.5 mm.
  PalmRow finger_row() const {
    PalmRow row;
    for (int f = 1; f < kFingers; ++f) {
      const double start = shape_.phalanx_mm[f][0] * kFingerStart,
                   radius = shape_.radius_mm[f][0] * 0.95;
      const FingerAxis axis(rest_, f);
      for (int i = 0; i <= kHalfRing; ++i)
        row[first_column(f) + i] =
            axis.point(start) + axis.axes(start)[0] * radius * std::cos(kPi * i / kHalfRing);
    }
    for (int f = 1; f + 1 < kFingers; ++f) {
      const int web = first_column(f) + kHalfRing;
      row[web + 1] = (row[web] + row[web + 2]) * 0.5 + glm::dvec3(0, 0, 2.5);
    }
    return row;
  }

  /// A row through one point per finger, extended by `border` mm to both sides of the hand.
  PalmRow row_through(const std::array<glm::dvec3, 5>& points, double border) const {
    std::vector<double> knots{0};
    std::vector<glm::dvec3> values{points[1] + glm::dvec3(border, 0, 0)};
    for (int f = 1; f < kFingers; ++f) {
      knots.push_back(first_column(f) + kHalfRing / 2.0);
      values.push_back(points[f]);
    }
    knots.push_back(kPalmColumns);
    values.push_back(points[4] - glm::dvec3(border, 0, 0));
    PalmRow row;
    for (int i = 0; i <= kPalmColumns; ++i) row[i] = interpolate(knots, values, i);
    return row;
  }

  /// A row across an oval. The spacing is mixed from that of equal widths and of equal angles, so
  /// that rays along the dorsal direction meet the oval at even distances.
  PalmRow oval_row(double thumb_side, double little_side, const glm::dvec3& offset) const {
    PalmRow row;
    for (int i = 0; i <= kPalmColumns; ++i) {
      const double even = 1 - 2.0 * i / kPalmColumns, round = std::cos(kPi * i / kPalmColumns);
      const double across = 0.5 + 0.5 * (0.35 * even + 0.65 * round);
      row[i] = glm::dvec3(std::lerp(little_side, thumb_side, across), 0, 0) + offset;
    }
    return row;
  }

  void lay_palm_rows() {
    std::array<glm::dvec3, 5> heads;
    for (int f = 0; f < kFingers; ++f) heads[f] = shape_.proximal_mm[f];
    const auto& base = shape_.metacarpal_mm;
    const double wrist = shape_.wrist_half_axes_mm.x;
    const std::vector<double> knots{0, kForearmRows, kForearmRows + 3.5, kPalmRows - 3.0,
                                    kPalmRows};
    const std::array<PalmRow, 5> guides{
        oval_row(wrist, -wrist, {0, 0, shape_.forearm_mm}), oval_row(wrist, -wrist, {0, 0, 0}),
        oval_row(base[1].x * 1.2 + 9, base[4].x * 1.2 - 9, {0, base[2].y, base[2].z}),
        row_through(heads, 10), finger_row()};
    for (int i = 0; i <= kPalmColumns; ++i) {
      std::vector<glm::dvec3> column;
      column.reserve(guides.size());
      for (const PalmRow& guide : guides) column.push_back(guide[i]);
      for (int j = 0; j <= kPalmRows; ++j) palm(i, j) = interpolate(knots, column, j);
    }
  }

  /// Lays the edge of the palm at which the thumb begins, and the straight edges before and after.
  void lay_thumb_side() {
    constexpr int kEnd = kThumbRow + kHalfRing;
    const FingerAxis thumb(rest_, 0);
    const double near_root = 6;
    const glm::dvec3 outer = thumb.point(near_root) +
                             thumb.axes(near_root)[0] * double(shape_.radius_mm[0][0]) +
                             glm::dvec3(0, 0, 4);
    const glm::dvec3 index =
        glm::mix(glm::dvec3(shape_.metacarpal_mm[1]), glm::dvec3(shape_.proximal_mm[1]), 0.65);
    const glm::dvec3 web =
        glm::mix(glm::dvec3(shape_.proximal_mm[0]), index, 0.55) + glm::dvec3(0, 0, -4);
    for (int i = 0; i <= kHalfRing; ++i)
      palm(0, kThumbRow + i) = glm::mix(outer, web, double(i) / kHalfRing);
    const glm::dvec3 wrist = palm(0, kForearmRows), last = palm(0, kPalmRows);
    for (int j = kForearmRows + 1; j < kThumbRow; ++j)
      palm(0, j) = glm::mix(wrist, outer, double(j - kForearmRows) / (kThumbRow - kForearmRows));
    for (int j = kEnd + 1; j < kPalmRows; ++j)
      palm(0, j) = glm::mix(web, last, double(j - kEnd) / (kPalmRows - kEnd));
  }

  bool is_pinned(int v) const {
    const SheetVertex& at = glove_.sheet()[v];
    if (at.finger >= 0 || glove_.on_seam(v)) return true;
    const bool thumb_root =
        at.column == 0 && at.row >= kThumbRow && at.row <= kThumbRow + kHalfRing;
    return thumb_root || at.row == kPalmRows;
  }

  /// Spreads the rows and columns of the palm evenly inside its pinned outline.
  void smooth_palm() {
    for (int round = 0; round < 60; ++round) {
      std::vector<glm::dvec3> sum(out_.middle.size(), glm::dvec3(0));
      std::vector<int> neighbours(out_.middle.size(), 0);
      for (const auto& [a, b] : glove_.sheet_edges()) {
        if (glove_.sheet()[a].finger >= 0 || glove_.sheet()[b].finger >= 0) continue;
        sum[a] += out_.middle[b], ++neighbours[a];
        sum[b] += out_.middle[a], ++neighbours[b];
      }
      for (int v = 0; v < glove_.sheet_count(); ++v)
        if (!is_pinned(v))
          out_.middle[v] += (sum[v] / double(neighbours[v]) - out_.middle[v]) * 0.6;
    }
  }

  /// Arc lengths of a finger's rows: even between joints, with a row at each joint.
  std::vector<double> row_arcs(int finger, const FingerAxis& axis) const {
    const double start =
                     finger == 0 ? kThumbStart * axis.joint_mm(1) : kFingerStart * axis.joint_mm(1),
                 end = axis.length_mm() - 0.3;
    const int rows = kFingerRows[finger];
    std::vector<double> knots{0}, arcs{start};
    for (int k = 1; k < 3; ++k) {
      if (axis.joint_mm(k) <= start + 4) continue;
      knots.push_back(std::round((axis.joint_mm(k) - start) / (axis.length_mm() - start) * rows));
      arcs.push_back(axis.joint_mm(k));
    }
    knots.push_back(rows);
    arcs.push_back(end);
    std::vector<double> result;
    for (int j = 0; j <= rows; ++j) result.push_back(interpolate(knots, arcs, j));
    return result;
  }

  void lay_finger(int finger) {
    const FingerAxis axis(rest_, finger);
    const std::vector<double> arcs = row_arcs(finger, axis);
    const double tip_radius = shape_.radius_mm[finger][3];
    for (int j = 1; j <= kFingerRows[finger]; ++j) {
      const double to_tip = axis.length_mm() - arcs[j], inward = (tip_radius - to_tip) / tip_radius;
      double radius = axis.radius_mm(shape_, arcs[j]);
      if (inward > 0) radius *= std::sqrt(std::max(1 - inward * inward, 0.30));
      const glm::dmat3 axes = axis.axes(arcs[j]);
      for (int i = 0; i <= kHalfRing; ++i) {
        const int v = glove_.finger_vertex(finger, i, j);
        out_.middle[v] = axis.point(arcs[j]) + axes[0] * radius * std::cos(kPi * i / kHalfRing);
        out_.dorsal[v] = axes[1];
        out_.half_thickness[v] =
            j < kFingerRows[finger] ? std::max(radius * std::sin(kPi * i / kHalfRing), 0.05) : 0.05;
      }
    }
  }

  /// Blends the dorsal direction of the thumb into that of the palm.
  void turn_thumb_root() {
    const glm::dvec3 thumb_dorsal = rest_.axes[kMetacarpal[0]][1];
    for (int j = kThumbRow; j <= kThumbRow + kHalfRing; ++j)
      for (int i = 0; i < 6; ++i) {
        const double share = 0.5 * (1 - i / 6.0);
        glm::dvec3& dorsal = out_.dorsal[glove_.palm_vertex(i, j)];
        dorsal = glm::normalize(glm::mix(dorsal, thumb_dorsal, share));
      }
  }

  const GloveTemplate& glove_;
  const HandShape& shape_;
  const RestPose& rest_;
  GloveLayout out_;
};

}  // namespace

GloveLayout lay_out_glove(const GloveTemplate& glove, const HandShape& shape,
                          const RestPose& rest) {
  return LayoutBuilder(glove, shape, rest).build();
}

}  // namespace handcast::renderer
