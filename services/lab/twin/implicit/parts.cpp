// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/parts.hpp"

namespace handcast::twin {
namespace {

using renderer::HandShape;
using renderer::RestPose;

/// A cross-section of an index finger at a share of a phalanx; 3 is the tip.
struct FingerSection {
  double phalanx, half_width_mm, back_mm, palm_mm;
};
/// Wide and thin-skinned at the joints, padded between them, flat at the nail.
constexpr std::array<FingerSection, 9> kFinger{{{-0.10, 9.6, 9.0, 9.5},
                                                {0.20, 9.4, 8.3, 10.4},
                                                {0.60, 8.9, 7.4, 10.0},
                                                {1.00, 9.7, 8.2, 8.3},
                                                {1.50, 8.6, 7.0, 9.0},
                                                {2.00, 8.5, 6.8, 7.2},
                                                {2.35, 8.5, 6.1, 8.1},
                                                {2.60, 8.1, 5.4, 7.8},
                                                {2.72, 7.5, 5.0, 7.2}}};
/// The sections of the thumb; 0 to 1 is its metacarpal.
constexpr std::array<FingerSection, 8> kThumb{{{0.00, 10.5, 9.5, 11.0},
                                               {0.45, 11.0, 9.6, 12.5},
                                               {1.00, 11.6, 9.8, 10.6},
                                               {1.50, 9.9, 8.4, 10.0},
                                               {2.00, 10.9, 8.6, 8.6},
                                               {2.40, 10.8, 7.0, 9.4},
                                               {2.62, 10.0, 5.8, 8.8},
                                               {2.74, 8.8, 5.0, 7.6}}};
/// The girth of each finger relative to these tables.
constexpr std::array<double, 5> kGirth{1.0, 1.0, 1.03, 0.97, 0.86};

/// The place on the axis of a share of a phalanx.
double along_mm(const std::vector<double>& ends_mm, double phalanx) {
  if (phalanx <= 0) return phalanx * ends_mm[1];
  const auto k = static_cast<std::size_t>(phalanx);
  if (k + 1 >= ends_mm.size()) return ends_mm.back();
  return ends_mm[k] + (phalanx - static_cast<double>(k)) * (ends_mm[k + 1] - ends_mm[k]);
}

template <std::size_t N>
std::vector<Section> sections(const std::array<FingerSection, N>& table,
                              const std::vector<double>& ends_mm, double girth) {
  std::vector<Section> sections;
  sections.reserve(table.size());
  for (const auto& [phalanx, half_width_mm, back_mm, palm_mm] : table)
    sections.push_back(
        {along_mm(ends_mm, phalanx), girth * half_width_mm, girth * back_mm, girth * palm_mm});
  return sections;
}

}  // namespace

HandShape implicit_shape() {
  HandShape shape = HandShape::mean();
  shape.metacarpal_mm = {{{24, -9, -17}, {14, 3, -22}, {3, 4, -23}, {-7, 3, -22}, {-15, 0, -20}}};
  shape.proximal_mm = {{{50, -22, -52}, {27, 3, -88}, {7, 5, -88}, {-13, 3, -80}, {-30, -1, -71}}};
  shape.phalanx_mm = {{{32, 27, 0}, {40, 23, 20}, {45, 27, 22}, {41, 26, 22}, {33, 18, 20}}};
  shape.splay_deg = {0, 12, 2, -9, -20};
  shape.flexion_deg = {};
  return shape;
}

Part finger_part(const HandShape& shape, const RestPose& rest, int finger) {
  const auto f = static_cast<std::size_t>(finger);
  const bool thumb = finger == 0;
  const int first = renderer::kMetacarpal[f] + (thumb ? 0 : 1);
  std::vector<double> ends_mm{0};
  std::vector<MovedBy> moved_by;
  if (!thumb) moved_by.push_back({first - 1, 0});
  for (int joint = first; joint < renderer::tip_of(finger); ++joint) {
    moved_by.push_back({joint, ends_mm.back()});
    ends_mm.push_back(ends_mm.back() +
                      glm::distance(rest.position_mm[joint + 1], rest.position_mm[joint]));
  }
  const double girth = kGirth[f] * shape.radius_mm[1][0] / HandShape::mean().radius_mm[1][0];
  auto skin = thumb ? sections(kThumb, ends_mm, girth) : sections(kFinger, ends_mm, girth);
  const double end_mm = ends_mm.back() - skin.back().along_mm;
  return {Limb(rest.position_mm[first], rest.axes[thumb ? first + 1 : first], std::move(skin), 8,
               end_mm),
          std::move(moved_by), 6.5 * girth};
}

namespace {

using renderer::HandShape;
using renderer::kMetacarpal;
using renderer::RestPose;

constexpr int kWrist = 1;
constexpr double kRigid = 1;  ///< a length: a part that one joint moves has nothing to blend

/// Axes along a direction whose back faces up.
glm::dmat3 axes_along(const glm::dvec3& direction) {
  const glm::dvec3 proximal = -glm::normalize(direction), up(0, 1, 0);
  const glm::dvec3 back = glm::normalize(up - proximal * glm::dot(up, proximal));
  return {glm::cross(back, proximal), back, proximal};
}

/// An ellipsoid that one joint moves, with its long axis along a direction.
Part ellipsoid(const glm::dvec3& middle, const glm::dvec3& along, const glm::dvec3& half_mm,
               int joint) {
  return {
      Limb(middle, axes_along(along), {{0, half_mm.x, half_mm.y, half_mm.y}}, half_mm.z, half_mm.z),
      {{joint, 0}},
      kRigid};
}

/// A metacarpal with the flesh between it and the next one, up to the knuckle.
Part metacarpal(const RestPose& rest, int finger) {
  const int joint = kMetacarpal[static_cast<std::size_t>(finger)];
  const glm::dvec3 base = rest.position_mm[joint], head = rest.position_mm[joint + 1];
  const double length = glm::distance(base, head), slim = finger == 4 ? 0.92 : 1;
  return {Limb(base, axes_along(head - base),
               {{0, 10.5 * slim, 9.5, 13},
                {0.5 * length, 11 * slim, 8.6, 12.5},
                {0.9 * length, 10.8 * slim, 8.8 * slim, 13 * slim},
                {1.02 * length, 10.4 * slim, 8.6 * slim, 12 * slim}},
               12, 11),
          {{joint, 0}},
          kRigid};
}

/// The web between a finger and the next one.
Part web(const HandShape& shape, const RestPose& rest, int finger) {
  const auto on_phalanx = [&](int f) {
    const auto i = static_cast<std::size_t>(f);
    const int knuckle = kMetacarpal[i] + 1;
    return rest.position_mm[knuckle] - rest.axes[knuckle][2] * (0.30 * shape.phalanx_mm[i][0]);
  };
  const glm::dvec3 one = on_phalanx(finger), other = on_phalanx(finger + 1);
  return ellipsoid((one + other) * 0.5 - glm::dvec3(0, 2.5, 0), other - one, {8, 6.5, 9},
                   kMetacarpal[static_cast<std::size_t>(finger)]);
}

/// Ball of the thumb, its web to the index finger, and the flesh on the little finger's side.
void add_balls(std::vector<Part>& parts, const RestPose& rest) {
  const auto between = [&](int joint, double share) {
    return glm::mix(rest.position_mm[joint], rest.position_mm[joint + 1], share);
  };
  const auto bone = [&](int joint) {
    return rest.position_mm[joint + 1] - rest.position_mm[joint];
  };
  const int thumb = kMetacarpal[0], index = kMetacarpal[1], little = kMetacarpal[4];
  parts.push_back(
      ellipsoid(between(thumb, 0.40) + glm::dvec3(-7, -3, -1), bone(thumb), {13, 13, 27}, thumb));
  const glm::dvec3 from = between(thumb, 0.66), to = between(index, 0.58) - glm::dvec3(0, 3, 0);
  parts.push_back(ellipsoid((from + to) * 0.5, to - from, {16, 7.5, 15}, thumb));
  parts.push_back(ellipsoid(between(little, 0.30) + glm::dvec3(-2, -7, 0), bone(little),
                            {11, 11.5, 30}, little));
}

}  // namespace

std::vector<Part> palm_parts(const HandShape& shape, const RestPose& rest) {
  std::vector<Part> parts;
  for (int f = 1; f < renderer::kFingers; ++f) parts.push_back(metacarpal(rest, f));
  for (int f = 1; f + 1 < renderer::kFingers; ++f) parts.push_back(web(shape, rest, f));
  add_balls(parts, rest);
  parts.push_back(ellipsoid({1, -6, -13}, {1, 0, 0}, {16, 11, 25}, kWrist));
  const glm::dvec2 half(shape.wrist_half_axes_mm);
  parts.push_back({Limb({0, 0, 0}, glm::dmat3(1),
                        {{-55, half.x * 1.04, half.y * 1.02, half.y * 1.02},
                         {-25, half.x * 0.98, half.y * 0.94, half.y * 0.95},
                         {0, half.x * 0.95, half.y * 0.82, half.y * 0.90},
                         {28, half.x * 0.95, half.y * 0.66, half.y * 0.80}},
                        4, 22),
                   {{kWrist, 0}},
                   kRigid});
  return parts;
}

}  // namespace handcast::twin
