// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace handcast::preview {

/// The rate of one stream over time.
struct RateGauge {
  std::string stream;               ///< name of the stream
  std::optional<double> wanted_hz;  ///< the configured rate; empty: there is none
  std::vector<float> held_hz;       ///< the measured rates, oldest first
};

/// The age of one kind of input when its light is seen, over time.
struct AgeGauge {
  std::string of;             ///< of what
  std::vector<float> age_ms;  ///< oldest first
};

/// The time that one stage took in the last 10 s.
struct StageGauge {
  std::string stage;  ///< name of the stage
  /// Median and 99th percentile.
  /// @{
  double p50_us = 0, p99_us = 0;
  /// @}
};

/// The figures of a rig.
struct Gauges {
  std::string rig;                 ///< name of the rig
  double uptime_s = 0;             ///< time since its supervisor was started
  std::vector<std::string> ill;    ///< sentences about what is not well
  std::vector<RateGauge> rates;    ///< the streams, in the order of a frame
  std::vector<AgeGauge> ages;      ///< image, tracker, landmarks
  std::vector<StageGauge> stages;  ///< in the order of a frame
  /// Time from one value to the next.
  /// @{
  double rates_period_s = 1, ages_period_s = 1;
  /// @}
};

}  // namespace handcast::preview
