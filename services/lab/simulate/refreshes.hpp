// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "config/sections/projector.hpp"
#include "config/sections/twin/projector.hpp"

namespace handcast::simulate {

/// The refreshes of a simulated projector, and which frame each of them shows. A frame begins with
/// every refresh, if the one before is finished by then; its light is on `leg_ns()` later if it is
/// finished within projector.software_ms, otherwise with the first refresh after that. Until then
/// the light of an earlier frame stays on. One thread.
class Refreshes {
 public:
  /// `seed` selects the times that frames take.
  Refreshes(const config::Projector& projector, const config::TwinProjector& errors, int seed);

  /// The beginning of a frame, ns since the epoch.
  std::int64_t begin_ns(std::int64_t frame) const;
  /// The middle of the light for which a frame is drawn.
  std::int64_t display_ns(std::int64_t frame) const { return begin_ns(frame) + leg_ns_; }
  /// The most refreshes that a frame can be late.
  static constexpr std::int64_t kLongestDelay = 64;
  /// The frame whose light is on at display_ns(frame): this one, or an earlier one.
  std::int64_t shown_at(std::int64_t frame);

 private:
  double work_ms(std::int64_t frame) const;
  void begin_next();

  config::TwinProjector errors_;
  int seed_;
  double rate_hz_, software_ms_;
  std::int64_t leg_ns_;
  /// The frame that each refresh shows, as far as frames have begun. Refreshes that no frame has
  /// reached yet show the newest before them.
  std::vector<std::int64_t> shown_;
  std::int64_t next_ = 0;     ///< the frame that begins next
  std::int64_t free_ns_ = 0;  ///< when the frame before it is finished
};

}  // namespace handcast::simulate
