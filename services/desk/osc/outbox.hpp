// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/base/surface.hpp"
#include "services/desk/osc/addresses.hpp"

namespace handcast::desk::osc {

/// What all are told: hands, gestures and events. One thread.
class Outbox {
 public:
  /// `rate_hz`: of hands.
  explicit Outbox(double rate_hz);

  /// The packets to send now. A hand is a bundle: /hand/left/there (T or F), pinch, spread, fist,
  /// open, point, palm_up, speed, touch (f, as Gesture), joints (26 times x, y, z in metres) and uv
  /// (26 times x, y).
  std::vector<std::string> packets(const Scene& scene);

 private:
  std::int64_t period_ns_;
  std::int64_t due_ns_ = 0;  ///< when the hands are told again
  std::array<bool, msg::kMaxHands> was_there_{};
};

/// What one receiver is told of the settings: the values that changed. One thread.
///
/// A value that the receiver itself has set comes back 0.3 s after its last message, not before: a
/// fader on a screen would jump under the finger.
class ValueTeller {
 public:
  /// `addresses` must outlive this object. `host`: of the receiver, "10.0.0.7".
  ValueTeller(const Addresses& addresses, std::string_view host);

  /// The messages to send now, CLOCK_MONOTONIC. The first call, and one after refresh(), tells the
  /// values of all settings.
  std::vector<std::string> packets(const Values& values, std::int64_t now_ns);
  void refresh();

 private:
  struct Told {
    std::string seen, told;  ///< the value as it was in the last call, and as it was told
    std::int64_t due_ns = 0;
  };
  const Addresses& addresses_;
  std::string own_source_;
  std::vector<Told> all_;  ///< by control
};

/// Sends packets to all of them; those that cannot be sent at once are lost.
void send_all(const std::vector<std::string>& packets, std::span<const int> sockets);

}  // namespace handcast::desk::osc
