// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/knobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/controls/control_value.hpp"
#include "services/desk/controls/file_watch.hpp"
#include "services/desk/knobs/gesture_list.hpp"

namespace handcast::desk {
namespace knobs {
namespace {

constexpr std::int64_t kPause_ns = 1'000'000'000 / 30;
constexpr const char* kSource = "gestures";
constexpr double kDeadBand = 0.005;  ///< smaller changes, as a share of the way, are noise
constexpr double kArrived = 0.001;   ///< of the way
constexpr double kNextStep = 0.6;    ///< so far beyond its step, a value takes the next one

/// As it is written into an assignment.
double printed(double number) {
  return std::strtod(fmt::format("{:.5g}", number).c_str(), nullptr);
}

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

class Knobs final : public Surface {
 public:
  Knobs(std::string file, const std::vector<GestureKnob>& knobs, Panel& panel)
      : file_(std::move(file)), watch_(file_), panel_(panel) {
    take(knobs);
  }

  void turn(const Scene& scene) override {
    if (watch_.has_changed(scene.now_ns)) read_again(scene.now_ns);
    if (scene.now_ns - turned_ns_ < kPause_ns) return;
    const double step_s = turned_ns_ == 0 ? 0 : ns_to_seconds(scene.now_ns - turned_ns_);
    turned_ns_ = scene.now_ns;
    const auto values = panel_.values();
    bool changes = false;
    for (auto& turner : turners_) {
      const auto control = turner.knob().control;
      const auto value = number_of(panel_.controls()[control], values->toml[control]);
      if (value && turner.turn(scene, step_s, *value)) changes = true;
    }
    if (changes) set_all(scene.now_ns);
  }

 private:
  void take(const std::vector<GestureKnob>& knobs) {
    turners_.clear();
    for (const auto& knob : knobs) turners_.emplace_back(knob);
  }

  void read_again(std::int64_t now_ns) {
    const auto knobs = read_gestures(file_, panel_.controls());
    if (!knobs)
      return complaints_.add(now_ns, knobs.error().what + "; the gestures stay as they are");
    take(*knobs);
    log::info("{} was read again", file_);
  }

  /// Sets all that hands turn now, so that a hand's way is one change for `undo`.
  void set_all(std::int64_t now_ns) {
    std::vector<std::string> assignments;
    for (const auto& turner : turners_) {
      if (!turner.wanted()) continue;
      const auto assignment =
          assign_number(panel_.controls()[turner.knob().control], *turner.wanted());
      if (!assignment) return complaints_.add(now_ns, assignment.error().what);
      assignments.push_back(*assignment);
    }
    if (const auto set = panel_.set(assignments, kSource); !set)
      return complaints_.add(now_ns, set.error().what);
    for (auto& turner : turners_)
      if (turner.wanted()) turner.was_set();
  }

  std::string file_;
  FileWatch watch_;
  Panel& panel_;
  Complaints complaints_{"gestures"};
  std::vector<Turner> turners_;
  std::int64_t turned_ns_ = 0;
};

}  // namespace
}  // namespace knobs

Result<std::unique_ptr<Surface>> open_knobs(const config::Rig& rig, Panel& panel) {
  const auto& file = rig.desk.gestures;
  if (file.empty()) return nullptr;
  const auto read = knobs::read_gestures(file, panel.controls());
  if (!read) return tl::make_unexpected(read.error());
  return std::make_unique<knobs::Knobs>(file, *read, panel);
}

}  // namespace handcast::desk
