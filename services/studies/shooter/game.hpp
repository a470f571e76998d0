// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::study {

/// What is on the palm: places in mm from its middle, x to the right, y to the fingers.
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

/// A game in which a ship at the wrist shoots at aliens that come down from the fingers. It begins
/// when the hand is seen, pauses when it leaves, and begins again some seconds after its end. Pure:
/// time and steering are given.
class ShooterGame {
 public:
  explicit ShooterGame(std::uint64_t seed) : seed_(seed) {}

  /// Goes on by a time, at most 0.1 s. `steer`: -1 (left) to 1; where the ship goes to. `is_seen`:
  /// the hand is there.
  void step(double step_s, float steer, bool is_seen);
  const ShooterScene& scene() const { return scene_; }

  static constexpr double kReload_s = 0.4, kRest_s = 4, kSafe_s = 1.5;

 private:
  void begin_wave();
  void move_aliens(float step_s);
  void move_shots(float step_s);
  void drop_bombs(float step_s);
  void lose_life();
  double random();

  std::uint64_t seed_, drawn_ = 0;
  ShooterScene scene_;
  float march_ = 1;  ///< direction of the aliens
  double reload_s_ = 0, rest_s_ = 0, burst_s_ = 0;
};

}  // namespace handcast::study
