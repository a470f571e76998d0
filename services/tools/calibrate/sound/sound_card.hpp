// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::calibrate {

/// The input of a sound card (ALSA). One thread.
class SoundCard {
 public:
  virtual ~SoundCard() = default;

  virtual double rate_hz() const = 0;  ///< samples per second, by the card's own clock
  /// Appends the next samples of the first channel, -1..1, and returns when they have arrived, some
  /// ms later. Errors: disconnected (the card is gone), bad_data (samples were lost).
  virtual Result<void> read(std::vector<float>& samples) = 0;
};

/// Opens a capture device by its ALSA name ("default", "hw:1,0"): 48 kHz, 16 bits, blocks of 5 ms,
/// or what is nearest to that. Errors: bad_config (there is no such device, or it cannot do this;
/// this build has no ALSA).
Result<std::unique_ptr<SoundCard>> open_sound_card(const std::string& device);

}  // namespace handcast::calibrate
