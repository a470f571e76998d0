// SPDX-License-Identifier: Apache-2.0
#include "services/studies/shooter/game.hpp"

#include <algorithm>
#include <array>

#include "services/lab/twin/random.hpp"

namespace handcast::study {
namespace {

using Scene = ShooterScene;

constexpr int kColumns = 5, kMiddle = 2, kRows = 3;
constexpr float kApart_mm = 9, kReach_mm = 4.2f;  ///< between aliens; within which one is hit
constexpr float kShot_mm_s = 70, kBomb_mm_s = 26, kShip_mm_s = 90;
constexpr float kMarch_mm_s = 9, kFaster = 1.25f;  ///< of the first wave; by wave
constexpr float kDescent_mm = 3.5f;
constexpr float kBombs_s = 0.55f;  ///< bombs a second of all aliens, in the first wave
constexpr std::array<int, kRows> kWorth{30, 20, 10};

}  // namespace

double ShooterGame::random() {
  return static_cast<double>(twin::mixed(seed_ ^ twin::mixed(++drawn_)) >> 11) * 0x1p-53;
}

void ShooterGame::begin_wave() {
  ++scene_.wave;
  march_ = 1;
  scene_.aliens.clear();
  scene_.shots_mm.clear();
  scene_.bombs_mm.clear();
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      scene_.aliens.push_back({{kApart_mm * static_cast<float>(column - kMiddle),
                                Scene::kTop_mm - 4 - kApart_mm * static_cast<float>(row)},
                               row});
}

void ShooterGame::step(double step_s, float steer, bool is_seen) {
  step_s = std::clamp(step_s, 0.0, 0.1);
  if (!is_seen) return;
  if (!scene_.is_playing) {
    rest_s_ -= step_s;
    if (rest_s_ > 0) return;
    scene_ = {};
    scene_.is_playing = true;
    begin_wave();
  }
  const auto dt = static_cast<float>(step_s);
  const float wanted_mm = std::clamp(steer, -1.f, 1.f) * Scene::kHalfWidth_mm;
  scene_.ship_mm += std::clamp(wanted_mm - scene_.ship_mm, -kShip_mm_s * dt, kShip_mm_s * dt);
  if ((burst_s_ -= step_s) <= 0) scene_.bursts_mm.clear();
  scene_.blink_s = std::max(0.0, scene_.blink_s - step_s);
  if ((reload_s_ -= step_s) <= 0) {
    scene_.shots_mm.emplace_back(scene_.ship_mm, Scene::kBottom_mm + 4);
    reload_s_ = kReload_s;
  }
  move_aliens(dt);
  move_shots(dt);
  drop_bombs(dt);
  if (scene_.is_playing && scene_.aliens.empty()) begin_wave();
}

/// They march to and fro, and come down at the edges. One that arrives at the ship takes a life,
/// and the wave begins again.
void ShooterGame::move_aliens(float step_s) {
  float speed = kMarch_mm_s, edge = 0;
  for (int wave = 1; wave < scene_.wave; ++wave) speed = std::min(60.f, speed * kFaster);
  for (auto& alien : scene_.aliens) {
    alien.at_mm.x += march_ * speed * step_s;
    edge = std::max(edge, march_ * alien.at_mm.x);
  }
  if (edge > Scene::kHalfWidth_mm) {
    march_ = -march_;
    for (auto& alien : scene_.aliens) alien.at_mm.y -= kDescent_mm;
  }
  const auto has_arrived = [](const auto& alien) {
    return alien.at_mm.y < Scene::kBottom_mm + kReach_mm;
  };
  if (std::ranges::none_of(scene_.aliens, has_arrived)) return;
  scene_.blink_s = 0;
  lose_life();
  if (!scene_.is_playing) return;
  --scene_.wave;
  begin_wave();
}

void ShooterGame::move_shots(float step_s) {
  std::erase_if(scene_.shots_mm, [&](glm::vec2& shot) {
    shot.y += kShot_mm_s * step_s;
    const auto hit = std::ranges::find_if(scene_.aliens, [&](const auto& alien) {
      return glm::distance(alien.at_mm, shot) < kReach_mm;
    });
    if (hit == scene_.aliens.end()) return shot.y > Scene::kTop_mm + 6;
    scene_.score += kWorth[static_cast<std::size_t>(hit->kind)];
    scene_.bursts_mm.push_back(hit->at_mm);
    burst_s_ = 0.25;
    scene_.aliens.erase(hit);
    return true;
  });
}

void ShooterGame::drop_bombs(float step_s) {
  if (!scene_.aliens.empty() &&
      random() < kBombs_s * step_s * static_cast<float>(scene_.wave + 1)) {
    const auto from =
        static_cast<std::size_t>(random() * static_cast<double>(scene_.aliens.size()));
    scene_.bombs_mm.push_back(scene_.aliens[from].at_mm);
  }
  bool is_hit = false;
  std::erase_if(scene_.bombs_mm, [&](glm::vec2& bomb) {
    bomb.y -= kBomb_mm_s * step_s;
    const bool hits = glm::distance(bomb, {scene_.ship_mm, Scene::kBottom_mm}) < kReach_mm;
    is_hit |= hits;
    return hits || bomb.y < Scene::kBottom_mm - 6;
  });
  if (is_hit) lose_life();
}

void ShooterGame::lose_life() {
  if (scene_.blink_s > 0) return;
  --scene_.lives;
  scene_.blink_s = kSafe_s;
  scene_.bursts_mm.emplace_back(scene_.ship_mm, Scene::kBottom_mm);
  burst_s_ = 0.4;
  if (scene_.lives > 0) return;
  scene_.is_playing = false;
  rest_s_ = kRest_s;
}

}  // namespace handcast::study
