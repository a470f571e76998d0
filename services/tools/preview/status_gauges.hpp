// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "config/sections/viewpoint.hpp"
#include "services/tools/preview/layout/gauges.hpp"

namespace handcast::preview {

/// The newest values of a figure, oldest first.
class Series {
 public:
  /// Keeps at most `most` values.
  explicit Series(std::size_t most) : most_(most) {}

  /// Adds a value.
  void add(float value);
  /// All values, oldest first.
  const std::vector<float>& values() const { return values_; }

 private:
  std::size_t most_;
  std::vector<float> values_;
};

/// The rate of a stream, from the numbers and times of the messages that were seen.
class RateMeter {
 public:
  /// A message was seen. Numbers that decrease begin anew.
  void saw(std::uint64_t sequence, std::int64_t published_ns);
  /// Messages per second since the last call; 0 if there was none.
  double take_hz();

 private:
  std::uint64_t first_ = 0, last_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
};

/// Sets uptime, troubles and stages, those of a frame of `projector`, from the output of `handcast
/// status --json`. What has another form than expected is left out.
void read_status(const nlohmann::json& status, config::Viewpoint projector, Gauges& gauges);
/// The configured rate of a stream; empty if there is none.
std::optional<double> wanted_hz(const nlohmann::json& status, std::string_view stream);

}  // namespace handcast::preview
