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
#include "renderer/pipeline/presence.hpp"

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
    bool alone = false;  ///< the tracker is silent, or was a moment ago: the landmarks go on by themselves
    bool news = true;    ///< since the last frame: what this one has may jump against it
    float presence = 1;  ///< 1..0: falls when the tracker has been silent for long; the light fades with it
  };
  /// Ask once a frame: filters remember their output. Nothing where the hand is not in sight.
  std::optional<Tracked> at(std::int64_t now_ns, std::int64_t target_ns);

  /// The pose at any time, as far as it is known by now.
  std::optional<msg::HandPose> pose_at(std::int64_t time_ns) const { return history_.at(time_ns, Presence::kLongest_ns); }
  /// The same, but nothing where the tracker has been silent for a while.
  std::optional<msg::HandPose> recent_pose(std::int64_t time_ns) const { return history_.at(time_ns); }
  /// Where the landmarks should be then, roughly; nothing where the hand is not in sight.
  std::optional<LandmarkPoints> landmarks_at(std::int64_t time_ns) const;
  bool alone() const { return alone_; }                            ///< as of the last frame
  std::int64_t begins_ns() const { return history_.begins_ns(); }  ///< the tracker jumped then: poses before are guesses
  std::int64_t newest_ns() const { return history_.newest_ns(); }  ///< of the tracker's samples; later poses are predicted

 private:
  calib::Calibration calibration_;
  PoseHistory history_;
  std::unique_ptr<LandmarkFilter> filter_;
  Presence presence_;
  bool alone_ = false, silent_ = false;
  bool news_ = false;                    ///< since the last frame
  int seen_again_ = 0;                   ///< detections since the tracker is heard again
  std::int64_t heard_ns_ = 0;            ///< when the newest tracker sample came
  std::optional<std::int64_t> seen_ns_;  ///< origin of the newest landmarks
  LandmarkPoints moved_px_{};            ///< from P to Q̂ in the last frame
};

}  // namespace handcast::renderer
