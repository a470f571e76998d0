// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "services/desk/base/surface.hpp"
#include "services/desk/osc/addresses.hpp"

namespace handcast::desk::osc {

/// What others are told: hands, gestures and events, and the values of settings that changed. One
/// thread.
class Outbox {
 public:
  /// `addresses` must outlive this object. `rate_hz`: of hands.
  Outbox(const Addresses& addresses, double rate_hz);

  /// The packets to send now. A hand is a bundle: /hand/left/there (T or F), pinch, spread, fist,
  /// palm_up, speed (f, as Gesture), joints (26 times x, y, z in metres) and uv (26 times x, y).
  /// The first call, and one after refresh(), tells the values of all settings.
  std::vector<std::string> packets(const Scene& scene, const Values& values);
  void refresh() { told_.assign(told_.size(), ""); }

 private:
  void add_values(const Values& values, std::vector<std::string>& packets);

  const Addresses& addresses_;
  std::int64_t period_ns_;
  std::int64_t due_ns_ = 0;        ///< when the hands are told again
  std::vector<std::string> told_;  ///< by control: its value as it was told last
  std::array<bool, msg::kMaxHands> was_there_{};
};

/// Sends packets to all of them; those that cannot be sent at once are lost.
void send_all(const std::vector<std::string>& packets, std::span<const int> sockets);

}  // namespace handcast::desk::osc
