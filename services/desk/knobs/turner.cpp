// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/turner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace handcast::desk::knobs {
namespace {

constexpr double kDeadBand = 0.005;  ///< smaller changes, as a share of the way, are noise
constexpr double kArrived = 0.001;   ///< of the way
constexpr double kNextStep = 0.6;    ///< so far beyond its step, a value takes the next one

/// As it is written into an assignment.
double printed(double number) {
  return std::strtod(fmt::format("{:.5g}", number).c_str(), nullptr);
}

}  // namespace

double Turner::target_at(double amount) const {
  const double share = (amount - knob_.from) / (knob_.to - knob_.from);
  return knob_.first + cues::progress(knob_.curve, share) * (knob_.last - knob_.first);
}

void Turner::begin(double value) {
  if (!before_) before_ = value;
  at_ = value;
  set_ = wanted_ = value;
  is_turning_ = true;
}

/// Goes on towards a value. Returns true if the setting changes.
bool Turner::step_to(double target, double step_s) {
  const double way = std::max(std::abs(knob_.last - knob_.first), 1e-9);
  at_ += (target - at_) * (knob_.smooth_s > 0 ? 1 - std::exp(-step_s / knob_.smooth_s) : 1);
  const bool has_arrived = std::abs(target - at_) < kArrived * way;
  if (has_arrived) at_ = target;
  if (knob_.steps > 0) {
    if (std::abs(at_ - *wanted_) > kNextStep) wanted_ = std::round(at_);
  } else {
    const bool is_at_end = has_arrived && (target == knob_.first || target == knob_.last ||
                                           (!was_there_ && target == before_));
    if (is_at_end || std::abs(at_ - *wanted_) >= kDeadBand * way) wanted_ = printed(at_);
  }
  return wanted_ != set_;
}

bool Turner::turn(const Scene& scene, double step_s, double value) {
  const auto amount = knob_.source.at(scene);
  if (is_turning_ && value != *set_) {
    is_turning_ = false;  // somebody else has turned it
    before_.reset();
  }
  if (amount && !std::exchange(was_there_, amount.has_value())) begin(value);
  was_there_ = amount.has_value();
  if (!is_turning_) return false;
  if (amount) return step_to(target_at(*amount), step_s);
  if (!knob_.returns || !before_) {
    is_turning_ = false;
    before_.reset();
    return false;
  }
  const bool changes = step_to(*before_, step_s);
  if (!changes && at_ == *before_) {
    is_turning_ = false;
    before_.reset();
  }
  return changes;
}

}  // namespace handcast::desk::knobs
