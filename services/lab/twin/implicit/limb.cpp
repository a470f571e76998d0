// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/limb.hpp"

#include <algorithm>
#include <utility>

namespace handcast::twin {
namespace {

/// Catmull-Rom interpolation between `at[k]` and `at[k + 1]`, whose places are `x`; 0 <= t <= 1.
double curve(const std::vector<Section>& at, std::size_t k, double t, double Section::*value) {
  const auto slope = [&](std::size_t i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, at.size() - 1);
    return (at[after].*value - at[before].*value) / (at[after].along_mm - at[before].along_mm);
  };
  const double length = at[k + 1].along_mm - at[k].along_mm, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * at[k].*value + (t3 - 2 * t2 + t) * length * slope(k) +
         (3 * t2 - 2 * t3) * at[k + 1].*value + (t3 - t2) * length * slope(k + 1);
}

}  // namespace

Limb::Limb(const glm::dvec3& origin, const glm::dmat3& axes, std::vector<Section> sections,
           double begin_mm, double end_mm)
    : origin_(origin),
      axes_(axes),
      sections_(std::move(sections)),
      begin_mm_(begin_mm),
      end_mm_(end_mm) {}

double Limb::along_mm(const glm::dvec3& point) const {
  return -glm::dot(axes_[2], point - origin_);
}

Section Limb::section_at(double along_mm) const {
  std::size_t k = 0;
  while (k + 1 < sections_.size() && sections_[k + 1].along_mm < along_mm) ++k;
  if (k + 1 == sections_.size()) return sections_.back();
  const double t =
      (along_mm - sections_[k].along_mm) / (sections_[k + 1].along_mm - sections_[k].along_mm);
  const auto value = [&](double Section::*which) { return curve(sections_, k, t, which); };
  return {along_mm, value(&Section::half_width_mm), value(&Section::back_mm),
          value(&Section::palm_mm)};
}

double Limb::distance_mm(const glm::dvec3& point) const {
  const glm::dvec3 local = glm::transpose(axes_) * (point - origin_);
  const double along = std::clamp(-local.z, sections_.front().along_mm, sections_.back().along_mm);
  const Section section = section_at(along);
  const double beyond = -local.z - along;
  const glm::dvec3 half(section.half_width_mm, local.y > 0 ? section.back_mm : section.palm_mm,
                        beyond < 0 ? begin_mm_ : end_mm_);
  const glm::dvec3 share = glm::dvec3(local.x, local.y, beyond) / half;
  const double level = glm::length(share), slope = glm::length(share / half);
  if (slope < 1e-9) return -std::min(half.x, half.y);
  return level * (level - 1) / slope;
}

}  // namespace handcast::twin
