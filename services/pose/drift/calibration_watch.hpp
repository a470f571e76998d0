// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "calib/drift/drift_watch.hpp"
#include "config/sections/drift.hpp"
#include "ipc/msg/drift_note.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::pose {

/// Compares what the tracker and the detector say about still hands with the calibration, while a
/// rig runs (calib::DriftWatch). One thread.
class CalibrationWatch {
 public:
  /// Watches as the settings say; see is_on().
  CalibrationWatch(const config::Drift& settings, const calib::Calibration& calibration);

  /// False: see() does nothing.
  bool is_on() const { return watch_.has_value(); }
  /// Adds a sample of the tracker, and then the landmarks that have waited for it.
  void see(const msg::HandPoses& poses);
  /// Adds landmarks, which wait for the tracker's sample of their time; at most half a second of
  /// them are kept. Those of another calibration are left out.
  void see(const msg::Landmarks& landmarks);

  /// What is known; no places if nothing is.
  calib::Drift drift() const { return watch_ ? watch_->drift() : calib::Drift(); }
  /// The same for stage marks.
  msg::DriftNote note() const;

 private:
  void take(const msg::Landmarks& landmarks);

  std::uint32_t calibration_;
  std::optional<calib::DriftWatch> watch_;
  std::deque<msg::Landmarks> waiting_;
};

/// Tells the log when a tracker has moved, once, and when it is back. One thread.
class DriftLog {
 public:
  /// Call it with what is known.
  void tell(const calib::Drift& drift);

 private:
  bool told_ = false;
};

}  // namespace handcast::pose
