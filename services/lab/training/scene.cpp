// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace handcast::landmarks::training {
namespace {

using renderer::JointFrames;

constexpr int kFineSide = handcast_network::kSide_px * Scene::kFine;
constexpr int kShadowSide = 96;
constexpr float kFront = -1;  // counter-clockwise from outside, on a screen whose y points down
constexpr std::size_t kBallsPerHand = 35;

/// A wave of period 1, close to a sine (two parabolas); turns > -64.
inline float wave_at(float turns) {
  turns += 64;
  const float u = 2 * (turns - static_cast<float>(static_cast<int>(turns))) - 1;
  return 4 * u * (1 - std::abs(u));
}

/// Variations of the skin's brightness: veins, stains, hair.
class Grain {
 public:
  explicit Grain(Dice& dice) {
    const float strength = dice.between(0, 0.09f);
    for (auto& wave : waves_) {
      const glm::vec3 way(dice.normal(1), dice.normal(1), dice.normal(1));
      wave.turns_per_m = glm::normalize(way + 1e-6f) / dice.magnitude(0.007f, 0.06f);
      wave.start = dice.uniform();
      wave.height = dice.normal(strength);
    }
  }
  float at(const glm::vec3& place_m) const {
    float sum = 1;
    for (const auto& wave : waves_)
      sum += wave.height * wave_at(glm::dot(wave.turns_per_m, place_m) + wave.start);
    return sum;
  }

 private:
  struct Wave {
    glm::vec3 turns_per_m;
    float start, height;
  };
  std::array<Wave, 4> waves_;
};

/// Sets the albedo of each vertex. A glove has no nails, knuckles or creases, but a weave.
void paint_skin(Dice& dice, const FleshModel& model, float tone, bool gloved,
                std::vector<float>& albedo) {
  const Grain grain(dice);
  const float speckle = dice.between(0, gloved ? 0.15f : 0.06f);
  std::array<float, 4> by_kind{1, dice.chance(0.7f) ? dice.between(0.7f, 1.4f) : 1,
                               dice.between(0.78f, 1.05f), dice.between(0.7f, 1.02f)};
  if (gloved) by_kind.fill(1);
  albedo.resize(model.mesh.vertex_count());
  for (std::size_t v = 0; v < albedo.size(); ++v)
    albedo[v] = tone * by_kind[static_cast<std::size_t>(model.skin[v])] *
                grain.at(model.mesh.positions[v]) * (1 + speckle * (2 * dice.uniform() - 1) * 1.7f);
}

std::vector<glm::vec3> balls_in(const JointFrames& joints) {
  std::vector<glm::vec3> balls;
  balls.reserve(kBallsPerHand);
  for (int finger = 0; finger < 5; ++finger)
    for (int joint = finger == 0 ? 2 : kFirstPhalanx[finger]; joint <= kTip[finger]; ++joint) {
      balls.emplace_back(joints[joint][3]);
      if (joint < kTip[finger])
        balls.push_back(0.5f * glm::vec3(joints[joint][3] + joints[joint + 1][3]));
    }
  return balls;
}

/// Bends the part behind the wrist about the wrist, gradually over the first 25 mm.
void bend_wrist(const FleshModel& model, const glm::mat4& camera_from_wrist,
                const glm::mat4& camera_from_arm, Surface& surface) {
  const glm::mat4 bent = camera_from_arm * glm::inverse(camera_from_wrist);
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    const float share = std::clamp((model.behind_m[v] + 0.005f) / 0.025f, 0.0f, 1.0f);
    if (share <= 0) continue;
    surface.positions[v] =
        glm::mix(surface.positions[v], glm::vec3(bent * glm::vec4(surface.positions[v], 1)), share);
    surface.normals[v] =
        glm::normalize(glm::mix(surface.normals[v], glm::mat3(bent) * surface.normals[v], share));
  }
}

}  // namespace

Scene::Scene(const calib::CameraModel& camera, const Region& region)
    : camera_(camera),
      inverse_depth_(kFineSide, kFineSide),
      fine_(kFineSide, kFineSide),
      shadow_depth_(kShadowSide, kShadowSide),
      grey_(handcast_network::kSide_px * handcast_network::kSide_px),
      cover_(handcast_network::kSide_px * handcast_network::kSide_px) {
  clear(region);
}

void Scene::clear(const Region& region) {
  shot_count_ = 0;
  std::ranges::fill(inverse_depth_.pixels(), 0.0f);
  std::ranges::fill(fine_.pixels(), 0.0f);
  const auto fine_at = [&](glm::vec2 image_px) {
    return (region.to_place(image_px) + 0.5f) * static_cast<float>(kFineSide) - 0.5f;
  };
  fine_origin_ = fine_at({0, 0});
  fine_from_image_ = glm::mat2(fine_at({1, 0}) - fine_origin_, fine_at({0, 1}) - fine_origin_);
}

glm::vec2 Scene::fine_px(const glm::vec3& place_m) const {
  const glm::vec2 image_px(
      static_cast<float>(camera_.fx_px) * place_m.x / place_m.z + static_cast<float>(camera_.cx_px),
      static_cast<float>(camera_.fy_px) * place_m.y / place_m.z +
          static_cast<float>(camera_.cy_px));
  return fine_origin_ + fine_from_image_ * image_px;
}

Scene::Shot& Scene::next_shot() {
  if (shots_.size() == shot_count_) shots_.emplace_back();
  return shots_[shot_count_++];
}

void Scene::add_hand(Dice& dice, const Person& person, const JointFrames& in_camera,
                     const Light& light) {
  const bool gloved = dice.chance(0.06f);
  const float tone = gloved ? dice.between(0.05f, 1.1f) : dice.between(0.5f, 1);
  const glm::mat4 bend = glm::rotate(glm::mat4(1), dice.normal(0.3f), {1, 0, 0}) *
                         glm::rotate(glm::mat4(1), dice.normal(0.18f), {0, 1, 0});
  const glm::mat4 camera_from_arm = in_camera[kWristJoint] * bend;

  Shot& hand = next_shot();
  hand.is_arm = false;
  const Flesh flesh = draw_flesh(dice, person.flesh);
  const FleshModel& model = *flesh.model;
  hand.surface.positions.resize(model.mesh.vertex_count());
  hand.surface.normals.resize(model.mesh.vertex_count());
  twin::pose(flesh.hand, in_camera, hand.surface.positions, hand.surface.normals);
  bend_wrist(model, in_camera[kWristJoint], camera_from_arm, hand.surface);
  const float fatter_m = dice.normal(0.0007f) + (gloved ? dice.between(0, 0.003f) : 0);
  for (std::size_t v = 0; v < hand.surface.positions.size(); ++v)
    hand.surface.positions[v] += fatter_m * hand.surface.normals[v];
  paint_skin(dice, model, tone, gloved, hand.surface.albedo);
  hand.triangles = &model.mesh.triangles;
  light.shade(hand.surface, hand.grey);
  if (dice.chance(0.75f))
    occlude(hand.surface, balls_in(in_camera), dice.between(0.2f, 1.8f), hand.grey);
  add_arm(dice, flesh.hand.mesh, camera_from_arm, tone, light);
}

void Scene::add_arm(Dice& dice, const renderer::HandMesh& hand, const glm::mat4& camera_from_arm,
                    float tone, const Light& light) {
  Shot& shot = next_shot();
  shot.is_arm = true;
  shot.arm =
      twin::make_forearm(hand, dice.chance(0.5f) ? dice.between(0.06f, 0.2f) : twin::kBareArm_m);
  const float skin = tone * dice.between(0.85f, 1.15f), cloth = tone * dice.between(0.05f, 1.9f),
              hair = dice.between(0, 0.12f);
  const std::size_t count = shot.arm.positions.size();
  shot.surface.positions.resize(count);
  shot.surface.normals.resize(count);
  shot.surface.albedo.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    shot.surface.positions[v] = glm::vec3(camera_from_arm * glm::vec4(shot.arm.positions[v], 1));
    shot.surface.positions[v].z = std::max(shot.surface.positions[v].z, 0.15f);
    shot.surface.normals[v] = glm::mat3(camera_from_arm) * shot.arm.normals[v];
    shot.surface.albedo[v] =
        (shot.arm.brightness[v] == 1 ? skin : cloth) * (1 + hair * (2 * dice.uniform() - 1));
  }
  shot.triangles = &shot.arm.triangles;
  light.shade(shot.surface, shot.grey);
}

/// Darkens the parts of each hand that the hand itself hides from the lamp: percentage-closer
/// filtering over 3x3 texels (Reeves et al. 1987).
void Scene::cast_shadows(const Light& light, float depth) {
  const glm::vec3 middle = shots_[0].surface.positions[0];
  const glm::mat4 lamp_from_camera = glm::lookAt(light.lamp_m(), middle, glm::vec3(0, 1, 0));
  const float scale = 0.9f * kShadowSide / 0.28f * glm::distance(light.lamp_m(), middle);
  for (std::size_t s = 0; s < shot_count_; ++s) {
    Shot& shot = shots_[s];
    if (shot.is_arm) continue;
    std::ranges::fill(shadow_depth_.pixels(), 0.0f);
    const std::size_t count = shot.surface.positions.size();
    shot.screen.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
      const glm::vec3 seen(lamp_from_camera * glm::vec4(shot.surface.positions[v], 1));
      const float nearness = 1 / std::max(-seen.z, 0.05f);
      shot.screen.x[v] = 0.5f * kShadowSide + scale * seen.x * nearness;
      shot.screen.y[v] = 0.5f * kShadowSide - scale * seen.y * nearness;
      shot.screen.inverse_depth[v] = nearness;
    }
    for (const auto& triangle : *shot.triangles)
      twin::draw_triangle(shot.screen, triangle, kFront, {0, 0, kShadowSide, kShadowSide},
                          shadow_depth_.view(), [](int, int, float, float, float) {});
    constexpr float kBias_m = 0.007f;
    for (std::size_t v = 0; v < count; ++v) {
      const auto x = static_cast<int>(std::lround(shot.screen.x[v])),
                 y = static_cast<int>(std::lround(shot.screen.y[v]));
      if (x < 1 || y < 1 || x >= kShadowSide - 1 || y >= kShadowSide - 1) continue;
      const float limit = 1 / (1 / shot.screen.inverse_depth[v] - kBias_m);
      int behind = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) behind += shadow_depth_.at(x + dx, y + dy) > limit;
      shot.grey[v] *= 1 - depth * static_cast<float>(behind) / 9;
    }
  }
}

void Scene::draw(Dice& dice, const Light& light) {
  if (dice.chance(0.4f)) cast_shadows(light, dice.between(0.2f, 0.8f));
  for (std::size_t s = 0; s < shot_count_; ++s) {
    Shot& shot = shots_[s];
    shot.screen.resize(shot.surface.positions.size());
    for (std::size_t v = 0; v < shot.surface.positions.size(); ++v) {
      const glm::vec2 px = fine_px(shot.surface.positions[v]);
      shot.screen.x[v] = px.x;
      shot.screen.y[v] = px.y;
      shot.screen.inverse_depth[v] = 1 / shot.surface.positions[v].z;
    }
    const auto out = fine_.view();
    for (const auto& triangle : *shot.triangles) {
      const float a = shot.grey[triangle[0]], b = shot.grey[triangle[1]],
                  c = shot.grey[triangle[2]];
      twin::draw_triangle(
          shot.screen, triangle, kFront, {0, 0, kFineSide, kFineSide}, inverse_depth_.view(),
          [&](int x, int y, float u, float v, float w) { out.at(x, y) = a * u + b * v + c * w; });
    }
  }
  gather();
}

void Scene::gather() {
  static_assert(kFine == 2);
  for (int y = 0; y < handcast_network::kSide_px; ++y) {
    const float *upper = fine_.row(2 * y), *lower = fine_.row(2 * y + 1);
    const float *near_upper = inverse_depth_.row(2 * y),
                *near_lower = inverse_depth_.row(2 * y + 1);
    for (int x = 0; x < handcast_network::kSide_px; ++x) {
      const int i = y * handcast_network::kSide_px + x;
      grey_[i] = 0.25f * (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
      cover_[i] = 0.25f * static_cast<float>((near_upper[2 * x] > 0) + (near_upper[2 * x + 1] > 0) +
                                             (near_lower[2 * x] > 0) + (near_lower[2 * x + 1] > 0));
    }
  }
}

bool Scene::sees(const glm::vec3& place_m, float radius_m) const {
  constexpr float kSlack_m = 0.006f;
  const glm::vec2 px = fine_px(place_m);
  const int x = static_cast<int>(std::lround(px.x)), y = static_cast<int>(std::lround(px.y));
  if (x < 0 || y < 0 || x >= kFineSide || y >= kFineSide) return false;
  return inverse_depth_.at(x, y) * (place_m.z - radius_m - kSlack_m) < 1;
}

}  // namespace handcast::landmarks::training
