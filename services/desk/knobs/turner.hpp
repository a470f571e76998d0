// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "services/desk/knobs/gesture_list.hpp"

namespace handcast::desk::knobs {

/// One setting on the hand that turns it. One thread.
///
/// When the hand comes, the value goes from where it is to where the hand holds it. A value that
/// somebody else changes is left to them until the hand has left and comes again.
class Turner {
 public:
  explicit Turner(const GestureKnob& knob) : knob_(knob) {}

  /// The hands `step_s` after the last call. `value`: of the setting, as a number (number_of()).
  /// Returns true if the setting is to become wanted().
  bool turn(const Scene& scene, double step_s, double value);
  /// What the setting is to be, as a number; empty if it is not turned now.
  std::optional<double> wanted() const { return is_turning_ ? wanted_ : std::nullopt; }
  /// wanted() was set.
  void was_set() { set_ = wanted_; }

  const GestureKnob& knob() const { return knob_; }

 private:
  void begin(double value);
  double target_at(double amount) const;
  bool step_to(double target, double step_s);

  GestureKnob knob_;
  bool was_there_ = false;              ///< the hand, in the turn before
  bool is_turning_ = false;             ///< by a hand, or on the way back
  double at_ = 0;                       ///< the smoothed value
  std::optional<double> before_;        ///< the value before the hand came, while it returns to it
  std::optional<double> set_, wanted_;  ///< as the setting is, and is to be; of a number as printed
};

}  // namespace handcast::desk::knobs
