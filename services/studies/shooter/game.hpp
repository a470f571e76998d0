// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace handcast::study {

/// What is on a palm: places in mm from its middle, x to the right, y to the fingers. Score, lives
/// and wave are those of all hands.
struct ShooterScene {
  static constexpr float kHalfWidth_mm = 30, kTop_mm = 34, kBottom_mm = -28;
  static constexpr int kLives = 4;

  struct Alien {
    glm::vec2 at_mm;
    int kind = 0;  ///< 0 to 2, by row
  };
  float ship_mm = 0;  ///< x; its y is kBottom_mm
  std::vector<Alien> aliens;
  std::vector<glm::vec2> shots_mm, bombs_mm;
  std::vector<glm::vec2> bursts_mm;  ///< of what was hit in the last moments
  int score = 0, lives = kLives, wave = 0;
  bool is_playing = false;
  double blink_s = 0;  ///< left of the time after a hit in which the ship blinks and is safe
};

/// What a hand does.
struct ShooterPlayer {
  float steer = 0;       ///< -1 (left) to 1: where the ship goes to
  bool is_seen = false;  ///< the hand is there
};

/// What happened in a step, to be heard.
struct ShooterEvents {
  bool has_shot = false, has_hit = false, has_lost = false;  ///< lost: a life
};

/// A game in which a ship at the wrist shoots at aliens that come down from the fingers. It begins
/// when a hand is seen, pauses on a hand that leaves, and begins again some seconds after its end.
/// Two hands have one score, one set of lives and one wave: it ends when no aliens are left on
/// either, and a hand that has shot its own ones down gets half of those of the other. Pure: time
/// and steering are given.
class ShooterGame {
 public:
  explicit ShooterGame(std::uint64_t seed, std::size_t hands = 1) : seed_(seed), fields_(hands) {}

  /// Goes on by a time, at most 0.1 s. `players`: one for each hand.
  ShooterEvents step(double step_s, std::span<const ShooterPlayer> players);
  const ShooterScene& scene(std::size_t hand = 0) const { return fields_[hand].scene; }

  static constexpr double kReload_s = 0.4, kRest_s = 4, kSafe_s = 1.5;

 private:
  /// The game on one hand.
  struct Field {
    ShooterScene scene;
    float march = 1;  ///< direction of its aliens
    double reload_s = 0, burst_s = 0;
  };
  void begin_wave();
  void begin_wave(Field& field);
  void step(Field& field, double step_s, float steer);
  void move_aliens(Field& field, float step_s);
  void move_shots(Field& field, float step_s);
  void drop_bombs(Field& field, float step_s);
  void lose_life(Field& field);
  void share_aliens();
  double random();

  std::uint64_t seed_, drawn_ = 0;
  std::vector<Field> fields_;
  int score_ = 0, lives_ = 0, wave_ = 0;
  bool is_playing_ = false;
  double rest_s_ = 0;
  ShooterEvents events_;
};

}  // namespace handcast::study
