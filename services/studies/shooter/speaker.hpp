// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/studies/shooter/game.hpp"

namespace handcast::study {

/// Samples of a sound a second, one channel.
inline constexpr int kSoundRate_hz = 48000;

enum class ShooterSound { shot, hit, loss };
/// The samples of a sound, -1..1.
const std::vector<float>& samples_of(ShooterSound sound);

/// Plays the sounds of the game on a sound device, on a thread that lives as long as the process: a
/// device may hang. One that is missing or hangs is named in the log once, and is tried again each
/// second; the game is silent meanwhile. At most one per process.
class ShooterSpeaker {
 public:
  /// `device`: its ALSA name; "": silence. Does not wait for it.
  explicit ShooterSpeaker(const std::string& device);
  /// Begins the sounds of what happened. Does not wait.
  void play(const ShooterEvents& events);

 private:
  class Voice;
  Voice* voice_ = nullptr;  ///< never deleted
};

}  // namespace handcast::study
