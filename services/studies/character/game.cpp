// SPDX-License-Identifier: Apache-2.0
#include "services/studies/character/game.hpp"

#include <algorithm>
#include <cmath>

#include "services/lab/twin/random.hpp"

namespace handcast::study {
namespace {

/// Reaches (renderer::HandPosture) of a finger that is bent, and of one that is straight again.
constexpr float kBent = 0.8f, kStraight = 0.9f;
constexpr double kLongestStep_s = 0.1;  ///< what the game pauses for longer is no one's time

}  // namespace

void BentFingers::see(const std::array<float, kTips>& reach) {
  for (std::size_t f = 0; f < kTips; ++f)
    is_bent_[f] = is_bent_[f] ? reach[f] < kStraight : reach[f] < kBent;
}

std::optional<std::size_t> BentFingers::only() const {
  if (std::ranges::count(is_bent_, true) != 1) return {};
  return static_cast<std::size_t>(std::ranges::find(is_bent_, true) - is_bent_.begin());
}

bool BentFingers::all_straight() const { return std::ranges::count(is_bent_, true) == 0; }

double CharacterGame::random(std::uint64_t what) const {
  const auto key = static_cast<std::uint64_t>(scene_.round) << 32 | what;
  return static_cast<double>(twin::mixed(seed_ ^ twin::mixed(key)) >> 11) * 0x1p-53;
}

void CharacterGame::step(double now_s, const std::array<glm::vec3, msg::kJoints>* joints) {
  const double step_s = last_s_ < 0 ? 0 : std::clamp(now_s - last_s_, 0.0, kLongestStep_s);
  last_s_ = now_s;
  scene_.rounds = rounds_;
  if (joints) fingers_.see(renderer::posture_of(*joints).reach);
  using Phase = CharacterScene::Phase;
  if (scene_.phase == Phase::waiting || scene_.phase == Phase::counting)
    wait(step_s, joints != nullptr);
  else if (scene_.phase == Phase::straighten && joints)
    straighten(step_s);
  else if (scene_.phase == Phase::asking && joints)
    ask(step_s);
}

/// A hand that leaves begins the wait and the count-down again.
void CharacterGame::wait(double step_s, bool is_seen) {
  using Phase = CharacterScene::Phase;
  in_phase_s_ = is_seen ? in_phase_s_ + step_s : 0;
  const double counted_s = in_phase_s_ - kSeen_s;
  scene_.phase = counted_s < 0 ? Phase::waiting : Phase::counting;
  scene_.countdown = static_cast<int>(std::ceil(kCountdown_s - std::max(0.0, counted_s)));
  if (counted_s < kCountdown_s) return;
  scene_.phase = Phase::straighten;
  in_phase_s_ = kStraight_s;  // the hand was seen for seconds; straight fingers are enough
}

void CharacterGame::straighten(double step_s) {
  in_phase_s_ = fingers_.all_straight() ? in_phase_s_ + step_s : 0;
  if (in_phase_s_ >= kStraight_s) begin_round();
}

void CharacterGame::begin_round() {
  ++scene_.round;
  scene_.phase = CharacterScene::Phase::asking;
  asked_s_ = held_s_ = 0;
  held_.reset();
  asked_ = static_cast<std::size_t>(random(0) * kTips);
  const auto character = [](double share) {
    return static_cast<std::size_t>(share * static_cast<double>(kCharacters.size()));
  };
  const std::size_t palm = character(random(1));
  scene_.palm = kCharacters[palm];
  std::array<std::size_t, kTips> taken{palm, palm, palm, palm};
  for (std::size_t tip = 0; tip < kTips; ++tip) {
    std::size_t at = character(random(2 + tip));
    while (tip != asked_ && std::ranges::find(taken, at) != taken.end())
      at = (at + 1) % kCharacters.size();
    taken[tip] = tip == asked_ ? palm : at;
    scene_.tips[tip] = kCharacters[taken[tip]];
  }
  shift_tips();
}

/// The characters on the tips jump every second.
void CharacterGame::shift_tips() {
  const auto second = static_cast<std::uint64_t>(asked_s_);
  for (std::size_t tip = 0; tip < kTips; ++tip)
    for (int axis = 0; axis < 2; ++axis)
      scene_.shift[tip][axis] = static_cast<float>(
          2 * random(100 + 16 * second + 2 * tip + static_cast<std::uint64_t>(axis)) - 1);
}

void CharacterGame::ask(double step_s) {
  asked_s_ += step_s;
  shift_tips();
  const auto only = fingers_.only();
  held_s_ = only && only == held_ ? held_s_ + step_s : 0;
  held_ = only;
  if (!only || held_s_ < kHeld_s) return;
  results_.push_back({scene_.palm, asked_, *only, asked_s_});
  in_phase_s_ = 0;
  scene_.phase =
      scene_.round == rounds_ ? CharacterScene::Phase::done : CharacterScene::Phase::straighten;
}

}  // namespace handcast::study
