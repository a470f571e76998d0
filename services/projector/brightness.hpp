// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/output/light.hpp"

namespace handcast::projector {

/// The brightness of the light, which rises at the start of a rig, so that it does not flash. One
/// thread.
class Brightness {
 public:
  /// `epoch_ns`: the start of the rig, see service::Context. The first light of a rig that is older
  /// than 10 s replaces that of another process and does not fade.
  Brightness(const config::Projector& settings, std::int64_t epoch_ns)
      : settings_(settings), epoch_ns_(epoch_ns), table_(renderer::light_table(settings)) {}

  /// The table for the light at `time_ns`, which must not decrease. Valid until the next call.
  const renderer::LightTable& at(std::int64_t time_ns) {
    if (!is_risen_) table_ = renderer::light_table(settings_, fade_at(time_ns));
    return table_;
  }
  /// The share of the full brightness at `time_ns`, which must not decrease, 0 to 1.
  double fade_at(std::int64_t time_ns) {
    if (first_ns_ == 0) {
      first_ns_ = time_ns;
      is_risen_ = settings_.fade_s == 0 || time_ns - epoch_ns_ > kStart_ns;
    }
    if (is_risen_) return 1;
    const double fade = ns_to_ms(time_ns - first_ns_) / (1e3 * settings_.fade_s);
    is_risen_ = fade >= 1;
    return std::min(fade, 1.);
  }

 private:
  static constexpr std::int64_t kStart_ns = 10'000'000'000;

  config::Projector settings_;
  std::int64_t epoch_ns_, first_ns_ = 0;
  bool is_risen_ = false;
  renderer::LightTable table_;
};

}  // namespace handcast::projector
