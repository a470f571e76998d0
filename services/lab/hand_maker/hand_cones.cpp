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

namespace {

/// Collects the cones of the palm. Offsets and radii are in tuned millimetres (flesh_scale()).
class PalmBuilder {
 public:
  PalmBuilder(const HandShape& shape, const RestPose& rest)
      : shape_(shape), rest_(rest), scale_(flesh_scale(shape)) {}

  Cones build() && {
    for (int f = 1; f < kFingers; ++f) add_ray(f);
    for (int f = 1; f + 1 < kFingers; ++f) add_web(f);
    add_pads();
    add_little_side();
    add_wrist();
    return std::move(cones_);
  }
  Cones build_thumb_ball() && {
    add_thumb();
    return std::move(cones_);
  }

 private:
  static constexpr double kHalf = 12;  ///< half thickness of the tuned palm

  glm::dvec3 base(int finger) const { return shape_.metacarpal_mm[finger]; }
  glm::dvec3 head(int finger) const { return shape_.proximal_mm[finger]; }

  void add(const glm::dvec3& from, const glm::dvec3& from_offset, const glm::dvec3& to,
           const glm::dvec3& to_offset, double radius_from, double radius_to) {
    cones_.emplace_back(from + from_offset * scale_, to + to_offset * scale_, radius_from * scale_,
                        radius_to * scale_);
  }

  /// Adds a metacarpal, the flesh between it and the next, and the knuckle.
  void add_ray(int f) {
    const double slimmer = f == 4 ? 0.93 : 1.0;
    const double border = f == 1 ? 2.0 : f == 4 ? -2.5 : 0.0;
    add(base(f), {border, -3, 0}, head(f), {border, -1.5, 0}, kHalf * 1.02 * slimmer,
        kHalf * 0.84 * slimmer);
    if (f < 4)
      add((base(f) + base(f + 1)) * 0.5, {0, -4, 0}, (head(f) + head(f + 1)) * 0.5, {0, -1.5, -7},
          kHalf * 0.98, kHalf * 0.72);
    add(head(f), {0, kHalf * 0.22, 14}, head(f), {0, kHalf * 0.30, -2}, kHalf * 0.55, kHalf * 0.58);
  }

  /// Adds the web between two fingers, on the palmar side of their axes, at about a quarter of the
  /// proximal phalanges.
  void add_web(int f) {
    const auto on_phalanx = [&](int finger, double share) {
      return head(finger) -
             rest_.axes[kMetacarpal[finger] + 1][2] * double(shape_.phalanx_mm[finger][0]) * share;
    };
    add(on_phalanx(f, 0.26), {0, -2.5, 0}, on_phalanx(f + 1, 0.28), {0, -2.5, 0}, 7.4, 7.2);
  }

  /// Adds the pads below the heads of the metacarpals.
  void add_pads() {
    add(head(1), {-2, -6, 0}, head(2), {0, -7, 0}, 7.5, 7);
    add(head(2), {0, -7, 0}, head(3), {0, -6, 0}, 7, 7);
    add(head(3), {0, -6, 0}, head(4), {1, -4.5, 0}, 7, 7);
  }

  /// Adds the thumb's metacarpal, its ball (thenar) and its web to the index finger.
  void add_thumb() {
    const glm::dvec3 root = base(0), bone = head(0) - root;
    const double cmc = shape_.radius_mm[0][0] / scale_, mcp = shape_.radius_mm[0][1] / scale_;
    add(root, {}, head(0), {}, cmc + 1, mcp);
    add(root, {-5, -2, 2}, root + bone * 0.45, {-8, -4, 2}, cmc * 0.85, cmc);
    add(root + bone * 0.35, {-8, -4, 2}, root + bone * 0.75, {-9, -3, 2}, cmc, mcp * 0.95);
    add(root + bone * 0.35, {-12, -3, 0}, root + bone * 0.60, {-18, 0, -4}, cmc * 0.85, cmc * 0.70);
    add(root + bone * 0.80, {}, base(1) * 0.35 + head(1) * 0.65, {0, -4, 0}, 7, 8);
    add(root + bone * 0.55, {}, (base(1) + head(1)) * 0.5, {0, -3, 0}, 9, 9);
  }

  /// Adds the hypothenar.
  void add_little_side() {
    const glm::dvec3 root = base(4), bone = head(4) - root;
    add(root, {-7, -6, 6}, root + bone * 0.66, {-6, -8, 0}, kHalf * 0.85, kHalf * 0.90);
    add(root, {-5, -3, 8}, root + bone * 0.80, {-4, -2, 0}, kHalf * 0.85, kHalf * 0.90);
  }

  /// Adds three cones side by side from the forearm's end into the palm. They are continuous at the
  /// wrist, where a joint would be visible as a band.
  void add_wrist() {
    constexpr double kUnionSwelling = 3.5, kWidening = 0.05;  // mm; forearm's mm per mm
    const glm::dvec2 half = glm::dvec2(shape_.wrist_half_axes_mm) / scale_;
    const double radius = half.y - kUnionSwelling, into_palm = 36;
    const double end = shape_.forearm_mm / scale_, end_radius = radius + kWidening * end;
    for (const double side : {-1.0, 0.0, 1.0}) {
      const double aside = side * (half.x - half.y);
      add({}, {aside, 0, end - end_radius}, {}, {aside * 1.2 + 1, -1, -into_palm}, end_radius,
          radius - kWidening * into_palm);
    }
  }

  const HandShape& shape_;
  const RestPose& rest_;
  double scale_;
  Cones cones_;
};

}  // namespace

Cones palm_cones(const HandShape& shape, const RestPose& rest) {
  return PalmBuilder(shape, rest).build();
}

Cones thumb_ball_cones(const HandShape& shape, const RestPose& rest) {
  return PalmBuilder(shape, rest).build_thumb_ball();
}

}  // namespace handcast::renderer
