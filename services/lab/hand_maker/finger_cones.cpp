// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/hand_field.hpp"

namespace handcast::renderer {
namespace {

/// Increase of a finger's radius by the smooth union of its cones, in tuned millimetres.
constexpr double kFingerSwelling = 1.5;
/// Half the distance between the two cones of the proximal, intermediate and distal phalanx, as a
/// share of the radius.
constexpr std::array<double, 3> kFlatness{0.10, 0.14, 0.20};

struct Phalanx {
  glm::dvec3 from, to;
  double radius_from, radius_to;
  glm::dvec3 lateral, dorsal, proximal;
  double length() const { return glm::distance(from, to); }
};

void add_pair(Cones& cones, const Phalanx& p, double flatness) {
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 aside = p.lateral * side * flatness;
    cones.emplace_back(p.from + aside * p.radius_from, p.to + aside * p.radius_to,
                       p.radius_from * (1 - flatness), p.radius_to * (1 - flatness));
  }
}

void add_pad_and_knuckle(Cones& cones, const Phalanx& p, double scale) {
  const double r = p.radius_from, end = p.radius_to, length = p.length();
  cones.emplace_back(p.from - p.proximal * length * 0.38 - p.dorsal * r * 0.25,
                     p.from - p.proximal * length * 0.62 - p.dorsal * r * 0.23, r * 0.77, r * 0.75);
  cones.emplace_back(p.to + p.dorsal * end * 0.22 + p.proximal * 2.0 * scale,
                     p.to + p.dorsal * end * 0.20 - p.proximal * 2.0 * scale, end * 0.85,
                     end * 0.82);
}

void add_pulp(Cones& cones, const Phalanx& p, double scale) {
  const double end = p.radius_to;
  cones.emplace_back(p.from - p.proximal * p.length() * 0.45 - p.dorsal * end * 0.30,
                     p.to - p.dorsal * end * 0.10 + p.proximal * scale, end * 0.92, end * 0.80);
}

}  // namespace

Cones finger_cones(const HandShape& shape, const RestPose& rest, int finger) {
  Cones cones;
  const double scale = flesh_scale(shape);
  const int count = phalanx_count(finger), first_radius = finger == 0 ? 1 : 0;
  for (int k = 0; k < count; ++k) {
    const int joint = kMetacarpal[finger] + 1 + k;
    const bool last = k == count - 1;
    const glm::dmat3& axes = rest.axes[joint];
    Phalanx p{rest.position_mm[joint],
              rest.position_mm[joint + 1],
              shape.radius_mm[finger][first_radius + k] - kFingerSwelling * scale,
              shape.radius_mm[finger][first_radius + k + 1] - kFingerSwelling * scale,
              axes[0],
              axes[1],
              axes[2]};
    if (last) p.to += p.proximal * (p.radius_to + 0.8 * scale);  // the tip joint lies on the skin
    add_pair(cones, p, kFlatness[k + 3 - count]);
    if (last)
      add_pulp(cones, p, scale);
    else
      add_pad_and_knuckle(cones, p, scale);
  }
  return cones;
}

}  // namespace handcast::renderer
