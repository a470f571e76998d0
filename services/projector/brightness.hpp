// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "config/sections/light.hpp"
#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/output/light.hpp"

namespace handcast::projector {

/// The brightness of the light, which rises at the start of a rig, so that it does not flash, and
/// falls at its end. One thread.
class Brightness {
 public:
  /// `epoch_ns`: the start of the rig, see service::Context. The first light of a rig that is older
  /// than 10 s replaces that of another process and does not fade.
  Brightness(const config::Projector& settings, const config::Light& light, std::int64_t epoch_ns)
      : settings_(settings),
        epoch_ns_(epoch_ns),
        is_black_(light.blackout),
        master_{light.master, light.master, 0, 0},
        table_(renderer::light_table(settings, 0)) {}

  /// Uses other settings from `time_ns` on. The master fades to its new value, a blackout is at
  /// once.
  void adjust(const config::Projector& settings, const config::Light& light, std::int64_t time_ns) {
    settings_ = settings;
    is_black_ = light.blackout;
    if (light.master != master_.to)
      master_ = {master_.at(time_ns), light.master, time_ns, seconds_to_ns(light.master_s)};
    table_share_ = -1;
  }

  /// The table for the light at `time_ns`, which must not decrease. Valid until the next call.
  const renderer::LightTable& at(std::int64_t time_ns) {
    if (const double share = fade_at(time_ns); share != table_share_)
      table_ = renderer::light_table(settings_, table_share_ = share);
    return table_;
  }
  /// The share of projector.brightness at `time_ns`, which must not decrease, 0 to 1.
  double fade_at(std::int64_t time_ns) {
    share_ = fall_ ? fall_->at(time_ns) : risen_at(time_ns);
    return is_black_ ? 0 : share_ * master_.at(time_ns);
  }
  /// Lets the light fall to black from `time_ns` on, evenly, in fade_s or `most_ns` if that is
  /// shorter. Only the first call counts.
  void fall(std::int64_t time_ns, std::int64_t most_ns) {
    if (!fall_) fall_ = Fall{share_, time_ns, std::min(seconds_to_ns(settings_.fade_s), most_ns)};
  }
  /// True if the light has fallen: what at() and fade_at() returned last is black, because of
  /// fall().
  bool has_fallen() const { return fall_ && share_ == 0; }

 private:
  static constexpr std::int64_t kStart_ns = 10'000'000'000;

  struct Fall {
    double from = 0;  ///< share of the full brightness at its start
    std::int64_t start_ns = 0, span_ns = 0;

    double at(std::int64_t time_ns) const {
      const std::int64_t left_ns = start_ns + span_ns - time_ns;
      if (left_ns <= 0) return 0;
      return from * std::min(1., static_cast<double>(left_ns) / static_cast<double>(span_ns));
    }
  };

  /// The master on its way to a new value.
  struct Master {
    double from = 1, to = 1;
    std::int64_t start_ns = 0, span_ns = 0;

    double at(std::int64_t time_ns) const {
      if (time_ns - start_ns >= span_ns) return to;
      const double share = static_cast<double>(std::max<std::int64_t>(0, time_ns - start_ns)) /
                           static_cast<double>(span_ns);
      return from + (to - from) * share;
    }
  };

  double risen_at(std::int64_t time_ns) {
    if (first_ns_ == 0) {
      first_ns_ = time_ns;
      is_risen_ = settings_.fade_s == 0 || time_ns - epoch_ns_ > kStart_ns;
    }
    if (is_risen_) return 1;
    const double share = ns_to_ms(time_ns - first_ns_) / (1e3 * settings_.fade_s);
    is_risen_ = share >= 1;
    return std::min(share, 1.);
  }

  config::Projector settings_;
  std::int64_t epoch_ns_, first_ns_ = 0;
  bool is_risen_ = false;
  bool is_black_ = false;  ///< light.blackout
  Master master_;
  std::optional<Fall> fall_;
  double share_ = 0;  ///< of the rise or fall, at the last fade_at()
  double table_share_ = 0;
  renderer::LightTable table_;  ///< for table_share_
};

}  // namespace handcast::projector
