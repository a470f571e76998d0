// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <utility>

#include "services/pose/pose_source.hpp"
#include "services/pose/watch/complaints.hpp"
#include "services/pose/watch/source_watch.hpp"

namespace handcast::pose {

/// A source whose samples are judged (SourceWatch) and whose faults are counted and logged. One
/// thread.
class WatchedSource final : public PoseSource {
 public:
  /// `name`: begins the sentences of the log, e.g. "pose 'leapc'".
  WatchedSource(const std::string& name, std::unique_ptr<PoseSource> source);

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override;
  bool needs_landmarks() const override { return source_->needs_landmarks(); }
  int views() const override { return source_->views(); }
  int awaited_view() const override { return source_->awaited_view(); }
  void see(const msg::Landmarks& landmarks, int view) override { source_->see(landmarks, view); }
  bool depends_on_calibration() const override { return source_->depends_on_calibration(); }
  bool is_adjustable() const override { return source_->is_adjustable(); }
  void adjust(const config::Rig& rig) override { source_->adjust(rig); }
  joints::Conventions conventions() const override { return source_->conventions(); }
  msg::TrackerFaults take_faults() override { return std::exchange(faults_, {}); }

  /// True if the newest sample has a hand, and none that repeats a pose.
  bool is_usable() const { return watch_.is_usable(); }

 private:
  std::unique_ptr<PoseSource> source_;
  SourceWatch watch_;
  Complaints complaints_;
  msg::TrackerFaults faults_;
};

}  // namespace handcast::pose
