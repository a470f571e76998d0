// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "calib/clock_map.hpp"
#include "calib/solve/latency/sound_delay.hpp"
#include "services/tools/calibrate/sound/sound_card.hpp"

namespace handcast::calibrate {

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
