// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/evaluation/twin/motion.hpp"

namespace handcast::twin {

/// The digital twin of a rig: a true hand over time, and what each sensor makes of it. Every answer
/// is a pure function of the settings, the seed and the time or index asked for, so several
/// processes hold the same world without talking. Times are ns since the rig's epoch (virtual or
/// real). Not thread-safe: one per thread.
class Twin {
 public:
  static Result<std::unique_ptr<Twin>> create(const config::Rig& rig,
                                              const calib::Calibration& calibration);
  virtual ~Twin() = default;

  // --- the truth ---
  virtual std::optional<JointFrames> joints(Side side,
                                            std::int64_t time_ns) const = 0;  ///< tracker space
  virtual const renderer::HandMesh& true_hand(
      Side side) const = 0;  ///< topology of the model's mesh
  /// The true places of the 21 landmarks, undistorted camera px.
  virtual std::optional<std::array<glm::vec2, msg::kLandmarks>> landmarks(
      Side side, std::int64_t time_ns) const = 0;

  // --- the tracker: sample k, and when it arrives ---
  struct TrackerSample {
    msg::HandPoses poses;  ///< header.origin_ns by the tracker's own clock, header.frame_id = k;
                           ///< count 0 where the sample is lost
    std::int64_t arrival_ns = 0;
  };
  virtual TrackerSample tracker_sample(std::uint64_t k) const = 0;
  virtual std::int64_t tracker_time_ns(std::uint64_t k) const = 0;  ///< true origin of sample k

  // --- the camera: frame k ---
  virtual std::int64_t camera_origin_ns(std::uint64_t k) const = 0;   ///< middle of its exposure
  virtual std::int64_t camera_arrival_ns(std::uint64_t k) const = 0;  ///< in memory
  virtual void camera_image(std::uint64_t k, renderer::View<std::uint8_t> image) const = 0;

  // --- the detector, run number n, on the camera frame (id, origin) it is given ---
  struct Detection {
    msg::Landmarks landmarks;
    std::int64_t age_ns = 0;  ///< it is done this long after the frame's origin
  };
  virtual Detection detect(std::uint64_t n, std::uint64_t frame_id,
                           std::int64_t origin_ns) const = 0;
};

/// What the light of one frame did on the true hand (METHOD section 5). Lengths in projector px and
/// mm at the point's distance.
struct FrameScore {
  std::int64_t lit_ns = 0;
  struct Hand {
    Side side = Side::left;
    double speed_m_s = 0;            ///< mean speed of the true visible surface points
    std::vector<float> interior_px;  ///< per scored surface point
    std::vector<float> interior_mm;
    int hand_px = 0, lit_px = 0;  ///< true hand pixels; those with light
    int spill_px = 0;             ///< lit pixels on neither hand nor arm, given to the nearest hand
    int union_px = 0;             ///< for IoU: true hand or lit (arm left out)
    double seam_px = 0;           ///< length of the edge of light inside the true hand
    double lag_px_s = 0,
           speed2_px_s2 =
               0;  ///< sums of error . velocity and |velocity|^2: equivalent latency = lag / speed2
  };
  std::vector<Hand> hands;
};

/// Scores projections against the truth. Keeps buffers; one thread.
class Judge {
 public:
  static std::unique_ptr<Judge> create(const Twin& twin, const calib::Calibration& calibration,
                                       int step_px);
  virtual ~Judge() = default;
  /// `projection.lit_ns` is on the twin's clock (ns since the epoch).
  virtual FrameScore score(const msg::Projection& projection) = 0;
};

}  // namespace handcast::twin
