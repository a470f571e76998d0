// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/recogniser.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "renderer/skin/skinning.hpp"
#include "services/content/projegraphy/shape.hpp"

namespace handcast::projegraphy {
namespace {

constexpr float kRadian = std::numbers::pi_v<float> / 180;
constexpr float kTurnStep_deg = 8;
constexpr int kTurnSteps = 6;         ///< to either side
constexpr std::size_t kRefined = 10;  ///< coarse placements that are refined
constexpr float kTurnCost = 0.025f;   ///< of a silhouette that is turned by 45 degrees
constexpr float kAreaCost = 0.35f;    ///< of the area that only one of two shapes covers
constexpr int kRounds = 4;            ///< of refining; each halves the steps

/// How the hands of an animal differ from the table: other people, other moments. Degrees.
struct Variant {
  float curl = 0, splay = 0, turn = 0, nod = 0, apart_m = 0;
};
constexpr std::array kVariants{Variant{},
                               Variant{.turn = 9, .apart_m = 0.006f},
                               Variant{.turn = -9, .apart_m = -0.006f},
                               Variant{.curl = 6, .nod = 8},
                               Variant{.curl = -5, .nod = -8},
                               Variant{.splay = 1, .turn = 5, .nod = 6, .apart_m = 0.01f},
                               Variant{.splay = -1, .turn = -5, .nod = -6, .apart_m = -0.01f}};

HeldHand varied(HeldHand hand, const Variant& by, float side) {
  for (auto& finger : hand.flexion)
    for (float& angle : finger) angle += by.curl;
  for (std::size_t f = 1; f < 5; ++f)
    hand.splay[f] += by.splay * 2 * (2.4f - static_cast<float>(f));
  hand.turn += by.turn;
  hand.nod += by.nod;
  hand.wrist_m.x += side * by.apart_m;
  return hand;
}

}  // namespace

/// One way to hold an animal.
struct Prototype {
  std::size_t animal = 0;
  Shape shape;
  std::vector<glm::vec2> joints;  ///< in the axes of the shape
};

namespace {

/// Seen from far away, so that only the angles count.
Prototype prototype_of(std::size_t animal, const Variant& by,
                       const std::array<const renderer::HandMesh*, 2>& meshes) {
  constexpr float kPx_per_m = 1000;
  const auto& hands = animals()[animal].hands;
  std::vector<FlatHand> flat;
  std::vector<glm::vec2> joints_px;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const auto joints = joints_of(*meshes[i], varied(hands[i], by,
                                                     hands.size() == 1 ? 0.f
                                                     : i == 0          ? -1.f
                                                                       : 1.f));
    std::vector<glm::vec3> places(meshes[i]->vertex_count());
    renderer::skin(*meshes[i], joints, places);
    flat.push_back({meshes[i], {}});
    for (const auto& at : places) flat.back().px.push_back(kPx_per_m * glm::vec2(at));
    for (const auto& joint : joints) joints_px.push_back(kPx_per_m * glm::vec2(joint[3]));
  }
  const auto silhouette = silhouette_of(flat);
  Prototype prototype{animal, Shape(silhouette), {}};
  for (const auto& px : joints_px)
    prototype.joints.push_back(prototype.shape.from_mask(silhouette.from_projector(px)));
  return prototype;
}

/// A prototype laid onto a silhouette.
struct Fit {
  const Prototype* prototype = nullptr;
  Placement placement;  ///< from the axes of the prototype to those of the silhouette
  float distance = 0;
};

float outline_distance(const Fit& fit, const Shape& seen) {
  return seen.distance_of(fit.prototype->shape, fit.placement);
}

/// With what the areas add, and the turn.
float whole_distance(const Fit& fit, const Shape& seen) {
  const float turns = fit.placement.angle_rad / (45 * kRadian);
  return outline_distance(fit, seen) +
         kAreaCost * (1 - seen.overlap_of(fit.prototype->shape, fit.placement)) +
         kTurnCost * turns * turns;
}

/// Moves, turns and scales as long as it brings the outlines nearer.
void refine(Fit& fit, const Shape& seen) {
  float step = 1;
  for (int round = 0; round < kRounds; ++round, step /= 2) {
    for (int k = 0; k < 8; ++k) {
      Fit moved = fit;
      const float way = k % 2 == 0 ? step : -step;
      if (k < 2)
        moved.placement.shift.x += 0.08f * way;
      else if (k < 4)
        moved.placement.shift.y += 0.08f * way;
      else if (k < 6)
        moved.placement.angle_rad += 4 * kRadian * way;
      else
        moved.placement.scale *= 1 + 0.06f * way;
      moved.distance = outline_distance(moved, seen);
      if (moved.distance < fit.distance) fit = moved;
    }
  }
}

}  // namespace

glm::vec2 Placement::operator()(glm::vec2 at) const {
  if (is_mirrored) at.x = -at.x;
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return scale * glm::vec2(c * at.x - s * at.y, s * at.x + c * at.y) + shift;
}

struct Recogniser::Shapes {
  std::vector<Prototype> prototypes;

  std::vector<Fit> coarse_fits(const Shape& seen, int only) const {
    std::vector<Fit> fits;
    for (const auto& prototype : prototypes) {
      if (only >= 0 && prototype.animal != static_cast<std::size_t>(only)) continue;
      for (const bool is_mirrored : {false, true})
        for (int step = -kTurnSteps; step <= kTurnSteps; ++step) {
          const float turn = kTurnStep_deg * static_cast<float>(step);
          Fit fit{&prototype, {.angle_rad = turn * kRadian, .is_mirrored = is_mirrored}, 0};
          fit.distance = outline_distance(fit, seen);
          fits.push_back(fit);
        }
    }
    return fits;
  }
  std::optional<Recognised> best(const Silhouette& silhouette, int only) const;
};

std::optional<Recognised> Recogniser::Shapes::best(const Silhouette& silhouette, int only) const {
  if (silhouette.area_px == 0) return std::nullopt;
  const Shape seen(silhouette);
  auto fits = coarse_fits(seen, only);
  if (fits.empty()) return std::nullopt;
  const auto count = std::min(fits.size(), kRefined * (only >= 0 ? 1 : 4));
  std::ranges::partial_sort(fits, fits.begin() + static_cast<std::ptrdiff_t>(count), {},
                            &Fit::distance);
  fits.resize(count);
  for (auto& fit : fits) {
    refine(fit, seen);
    fit.distance = whole_distance(fit, seen);
  }
  const auto& found = *std::ranges::min_element(fits, {}, &Fit::distance);
  Recognised result;
  result.distance = found.distance;
  if (only >= 0 || found.distance <= animals()[found.prototype->animal].farthest)
    result.animal = static_cast<int>(found.prototype->animal);
  result.is_mirrored = found.placement.is_mirrored;
  result.unit_px = found.placement.scale * seen.unit_px();
  for (const auto& fit : fits)
    if (fit.prototype->animal != found.prototype->animal)
      result.runner_up = std::min(result.runner_up, fit.distance);
  for (const auto& joint : found.prototype->joints)
    result.joints_px.push_back(seen.to_mask(found.placement(joint)));
  return result;
}

Recogniser::Recogniser(const std::array<const renderer::HandMesh*, 2>& meshes,
                       const std::stop_token& stop) {
  auto shapes = std::make_unique<Shapes>();
  for (std::size_t animal = 0; animal < animals().size(); ++animal)
    for (const auto& variant : kVariants) {
      if (stop.stop_requested()) break;
      shapes->prototypes.push_back(prototype_of(animal, variant, meshes));
    }
  shapes_ = std::move(shapes);
}
Recogniser::Recogniser(Recogniser&&) noexcept = default;
Recogniser::~Recogniser() = default;

std::optional<Recognised> Recogniser::recognise(const Silhouette& silhouette) const {
  return shapes_->best(silhouette, -1);
}

std::optional<Recognised> Recogniser::place(const Silhouette& silhouette, int animal) const {
  return shapes_->best(silhouette, animal);
}

}  // namespace handcast::projegraphy
