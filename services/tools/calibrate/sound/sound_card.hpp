// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "calib/clock_map.hpp"
#include "calib/solve/latency/sound_delay.hpp"
#include "ipc/base/result.hpp"

/// A sound card as a clocked voltmeter, for a photodiode.
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

/// Records a sound card on a thread of its own, and maps the card's clock to CLOCK_MONOTONIC by the
/// arrivals of its samples. The time from the voltage to the arrival that no block is faster than
/// (the converter, the bus) stays in the times: about 1 to 2 ms.
class Recorder {
 public:
  /// Begins.
  explicit Recorder(std::unique_ptr<SoundCard> card);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();

  /// Ends, and returns what was recorded. Call it once. Errors: those of SoundCard::read();
  /// bad_data (less than half a second).
  Result<calib::SoundClip> finish();

 private:
  void record(const std::stop_token& asked);

  std::unique_ptr<SoundCard> card_;
  calib::ClockMap clock_;
  std::vector<float> samples_;
  std::optional<Error> error_;
  std::jthread thread_;  ///< owns all of the above until it has ended
};

}  // namespace handcast::calibrate
