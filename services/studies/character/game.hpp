// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "renderer/hand/hand_posture.hpp"

namespace handcast::study {

/// The characters of the game, 43 (Casper DPM, supplement).
inline constexpr std::string_view kCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ012345678!@#$%^&?";
/// Index to little finger.
inline constexpr std::size_t kTips = 4;

/// Which fingers are bent, of index to little finger, with hysteresis: a finger is bent below one
/// reach and straight above another.
class BentFingers {
 public:
  void see(const std::array<float, kTips>& reach);
  /// The one bent finger; empty if there is none, or more than one.
  std::optional<std::size_t> only() const;
  bool all_straight() const;

 private:
  std::array<bool, kTips> is_bent_{};
};

/// What the hand shows.
struct CharacterScene {
  enum class Phase { waiting, counting, straighten, asking, done };
  Phase phase = Phase::waiting;
  int countdown = 0;  ///< counting: seconds left
  char palm = ' ';
  std::array<char, kTips> tips{' ', ' ', ' ', ' '};
  std::array<glm::vec2, kTips> shift{};  ///< of the characters on the tips, -1..1
  int round = 0, rounds = 0;
};

/// The answer to a round.
struct CharacterRound {
  char palm = ' ';
  std::size_t asked = 0, picked = 0;  ///< fingers: 0 the index finger
  double seconds = 0;                 ///< without the time in which no hand was seen
  bool is_correct() const { return asked == picked; }
};

/// Guess the Character (Casper DPM): a character on the palm is also on one of four finger tips;
/// the finger with it is to be bent, as fast as possible. A session begins when a hand has been
/// seen for 3 s, and a count-down of 3 s. Between rounds all fingers are straight for a second.
/// Pure: time and hand are given.
class CharacterGame {
 public:
  CharacterGame(std::uint64_t seed, int rounds) : seed_(seed), rounds_(rounds) {}

  /// Goes on to a time. `joints`: of the hand, any space, m; null if it is not seen. An answer is a
  /// finger that alone is bent for kHeld_s.
  void step(double now_s, const std::array<glm::vec3, msg::kJoints>* joints);
  const CharacterScene& scene() const { return scene_; }
  /// The rounds that were answered, in order.
  const std::vector<CharacterRound>& results() const { return results_; }
  bool is_over() const { return scene_.phase == CharacterScene::Phase::done; }

  static constexpr double kSeen_s = 3, kCountdown_s = 3, kStraight_s = 1, kHeld_s = 0.15;

 private:
  void wait(double step_s, bool is_seen);
  void straighten(double step_s);
  void ask(double step_s);
  void begin_round();
  void shift_tips();
  double random(std::uint64_t what) const;

  std::uint64_t seed_;
  int rounds_;
  double last_s_ = -1;
  double in_phase_s_ = 0, held_s_ = 0, asked_s_ = 0;
  std::optional<std::size_t> held_;
  BentFingers fingers_;
  std::size_t asked_ = 0;
  CharacterScene scene_;
  std::vector<CharacterRound> results_;
};

}  // namespace handcast::study
