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

}  // namespace handcast::twin
