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

void ShooterGame::begin_wave(Field& field) {
  auto& scene = field.scene;
  field.march = 1;
  scene.aliens.clear();
  scene.shots_mm.clear();
  scene.bombs_mm.clear();
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      scene.aliens.push_back({{kApart_mm * static_cast<float>(column - kMiddle),
                               Scene::kTop_mm - 4 - kApart_mm * static_cast<float>(row)},
                              row});
}

void ShooterGame::begin_wave() {
  ++wave_;
  for (auto& field : fields_) begin_wave(field);
}

ShooterEvents ShooterGame::step(double step_s, std::span<const ShooterPlayer> players) {
  step_s = std::clamp(step_s, 0.0, 0.1);
  events_ = {};
  if (std::ranges::none_of(players, &ShooterPlayer::is_seen)) return events_;
  if (!is_playing_) {
    rest_s_ -= step_s;
    if (rest_s_ > 0) return events_;
    for (auto& field : fields_) field = {};
    score_ = wave_ = 0;
    lives_ = Scene::kLives;
    is_playing_ = true;
    begin_wave();
  }
  for (std::size_t hand = 0; hand < fields_.size() && is_playing_; ++hand)
    if (players[hand].is_seen) step(fields_[hand], step_s, players[hand].steer);
  if (is_playing_) share_aliens();
  for (auto& field : fields_) {
    field.scene.score = score_;
    field.scene.lives = lives_;
    field.scene.wave = wave_;
    field.scene.is_playing = is_playing_;
  }
  return events_;
}

void ShooterGame::step(Field& field, double step_s, float steer) {
  auto& scene = field.scene;
  const auto dt = static_cast<float>(step_s);
  const float wanted_mm = std::clamp(steer, -1.f, 1.f) * Scene::kHalfWidth_mm;
  scene.ship_mm += std::clamp(wanted_mm - scene.ship_mm, -kShip_mm_s * dt, kShip_mm_s * dt);
  if ((field.burst_s -= step_s) <= 0) scene.bursts_mm.clear();
  scene.blink_s = std::max(0.0, scene.blink_s - step_s);
  if ((field.reload_s -= step_s) <= 0) {
    scene.shots_mm.emplace_back(scene.ship_mm, Scene::kBottom_mm + 4);
    field.reload_s = kReload_s;
    events_.has_shot = true;
  }
  move_aliens(field, dt);
  move_shots(field, dt);
  drop_bombs(field, dt);
}

/// A hand without aliens gets every second one of the hand that has most; a wave without any is
/// over.
void ShooterGame::share_aliens() {
  const auto count = [](const Field& field) { return field.scene.aliens.size(); };
  const auto most = std::ranges::max_element(fields_, {}, count);
  if (count(*most) == 0) return begin_wave();
  for (auto& field : fields_) {
    if (count(field) > 0 || count(*most) < 2) continue;
    auto& theirs = most->scene.aliens;
    for (std::size_t i = 1; i < theirs.size(); ++i) {
      field.scene.aliens.push_back(theirs[i]);
      theirs.erase(theirs.begin() + static_cast<std::ptrdiff_t>(i));
    }
    field.march = most->march;
  }
}

/// They march to and fro, and come down at the edges. If one arrives at the ship, a life is lost
/// and those of this hand begin again.
void ShooterGame::move_aliens(Field& field, float step_s) {
  auto& aliens = field.scene.aliens;
  float speed = kMarch_mm_s, edge = 0;
  for (int wave = 1; wave < wave_; ++wave) speed = std::min(60.f, speed * kFaster);
  for (auto& alien : aliens) {
    alien.at_mm.x += field.march * speed * step_s;
    edge = std::max(edge, field.march * alien.at_mm.x);
  }
  if (edge > Scene::kHalfWidth_mm) {
    field.march = -field.march;
    for (auto& alien : aliens) alien.at_mm.y -= kDescent_mm;
  }
  const auto has_arrived = [](const auto& alien) {
    return alien.at_mm.y < Scene::kBottom_mm + kReach_mm;
  };
  if (std::ranges::none_of(aliens, has_arrived)) return;
  field.scene.blink_s = 0;
  lose_life(field);
  if (is_playing_) begin_wave(field);
}

void ShooterGame::move_shots(Field& field, float step_s) {
  auto& scene = field.scene;
  std::erase_if(scene.shots_mm, [&](glm::vec2& shot) {
    shot.y += kShot_mm_s * step_s;
    const auto hit = std::ranges::find_if(scene.aliens, [&](const auto& alien) {
      return glm::distance(alien.at_mm, shot) < kReach_mm;
    });
    if (hit == scene.aliens.end()) return shot.y > Scene::kTop_mm + 6;
    score_ += kWorth[static_cast<std::size_t>(hit->kind)];
    scene.bursts_mm.push_back(hit->at_mm);
    field.burst_s = 0.25;
    events_.has_hit = true;
    scene.aliens.erase(hit);
    return true;
  });
}

void ShooterGame::drop_bombs(Field& field, float step_s) {
  auto& scene = field.scene;
  if (!scene.aliens.empty() && random() < kBombs_s * step_s * static_cast<float>(wave_ + 1)) {
    const auto from = static_cast<std::size_t>(random() * static_cast<double>(scene.aliens.size()));
    scene.bombs_mm.push_back(scene.aliens[from].at_mm);
  }
  bool is_hit = false;
  std::erase_if(scene.bombs_mm, [&](glm::vec2& bomb) {
    bomb.y -= kBomb_mm_s * step_s;
    const bool hits = glm::distance(bomb, {scene.ship_mm, Scene::kBottom_mm}) < kReach_mm;
    is_hit |= hits;
    return hits || bomb.y < Scene::kBottom_mm - 6;
  });
  if (is_hit) lose_life(field);
}

void ShooterGame::lose_life(Field& field) {
  auto& scene = field.scene;
  if (scene.blink_s > 0) return;
  --lives_;
  scene.blink_s = kSafe_s;
  scene.bursts_mm.emplace_back(scene.ship_mm, Scene::kBottom_mm);
  field.burst_s = 0.4;
  events_.has_lost = true;
  if (lives_ > 0) return;
  is_playing_ = false;
  rest_s_ = kRest_s;
}

}  // namespace handcast::study
