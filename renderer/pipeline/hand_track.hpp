#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/cascade/landmark_filter.hpp"
#include "renderer/cascade/pose_history.hpp"

namespace handcast::renderer {

/// Where the camera sees the 21 landmarks of a pose (undistorted px); nothing where one is behind the camera or nearly in it.
std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration, const msg::HandPose& pose);

/// The first steps of the cascade for one hand: its pose and its landmarks at the time of the photons.
class HandTrack {
 public:
  HandTrack(const config::Cascade& settings, const calib::Calibration& calibration, LandmarkOracle oracle = {});

  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);
  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen);

  struct Tracked {
    msg::HandPose pose;        ///< tracker space, at the target time
    LandmarkPoints tracker;    ///< P
    LandmarkPoints corrected;  ///< Q̂, or P
    bool has_landmarks = false;
  };
  /// Ask once a frame: filters remember their output. Nothing where the hand is not in sight.
  std::optional<Tracked> at(std::int64_t now_ns, std::int64_t target_ns);

  /// The pose at any time, as far as it is known by now.
  std::optional<msg::HandPose> pose_at(std::int64_t time_ns) const { return history_.at(time_ns); }

 private:
  calib::Calibration calibration_;
  PoseHistory history_;
  std::unique_ptr<LandmarkFilter> filter_;
};

}  // namespace handcast::renderer
