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
#include "services/lab/twin/flat_picture.hpp"
#include "services/lab/twin/motion.hpp"
#include "services/lab/twin/true_geometry.hpp"
#include "services/lab/twin/true_hands.hpp"

namespace handcast::twin {

/// The digital twin of a rig: the true hands over time and the output of each sensor
/// (`docs/method.md#twin`). Every result is a pure function of the settings, the seed and the
/// arguments, so that several processes agree without communication. Times are ns since the rig's
/// epoch (virtual or real). Not thread-safe: use one object per thread.
class Twin {
 public:
  /// Creates the twin of a rig; copies what it needs. Camera and detector are those of a viewpoint;
  /// the world is the same for all. Errors: bad_config (the calibration has no such camera), those
  /// of open_motion and of loading the hand models (bad_config).
  static Result<std::unique_ptr<Twin>> create(const config::Rig& rig,
                                              const calib::Calibration& calibration,
                                              config::Viewpoint at = config::Viewpoint::first);
  virtual ~Twin() = default;

  /// Gives the sensors other errors from now on: `twin.tracker`, but its rate, `twin.detector` and
  /// `twin.image`. The world and its motion stay.
  virtual void adjust(const config::Twin& settings) = 0;

  /// The true joints of one hand in tracker space; empty if there is no such hand at that time, and
  /// always if `twin.prop` replaces the hands.
  virtual std::optional<JointFrames> joints(Side side, std::int64_t time_ns) const = 0;
  /// The true hands and what their texture means. The first use takes up to a second.
  virtual const TrueHands& hands() const = 0;
  /// The ground-truth mesh of one hand: hands().of(). Valid as long as the twin.
  const TrueHand& true_hand(Side side) const { return hands().of(side); }
  /// The rig as it is; the calibration is what it believes.
  virtual const TrueGeometry& geometry() const = 0;
  /// The true positions of the 21 landmarks, camera px, undistorted as the rig believes; empty as
  /// joints().
  virtual std::optional<std::array<glm::vec2, msg::kLandmarks>> landmarks(
      Side side, std::int64_t time_ns) const = 0;

  /// One sample of the tracker.
  struct TrackerSample {
    /// header.frame_id is the number of the sample, header.origin_ns its time by the tracker's
    /// clock; count is 0 if the sample is lost.
    msg::HandPoses poses;
    std::int64_t arrival_ns = 0;  ///< time at which it is available
  };
  /// Sample `k` of the tracker.
  virtual TrackerSample tracker_sample(std::uint64_t k) const = 0;
  /// The true time of sample `k`.
  virtual std::int64_t tracker_time_ns(std::uint64_t k) const = 0;

  /// The middle of the exposure of camera frame `k`.
  virtual std::int64_t camera_origin_ns(std::uint64_t k) const = 0;
  /// That time by the camera's clock: the stamp of the frame, and all that the cascade knows.
  virtual std::int64_t camera_stamp_ns(std::uint64_t k) const = 0;
  /// True if camera frame `k` never arrives.
  virtual bool camera_lost(std::uint64_t k) const = 0;
  /// The time at which camera frame `k` is in memory. Does not decrease with k; several frames may
  /// arrive together.
  virtual std::int64_t camera_arrival_ns(std::uint64_t k) const = 0;
  /// Draws camera frame `k`. `image` must have the size of the calibration's camera.
  virtual void camera_image(std::uint64_t k, renderer::View<std::uint8_t> image) const = 0;
  /// The same while the projector shows `light`, which reaches a board and the table behind it
  /// (`twin.image.leak` of it). Hands show a pattern of their own instead.
  virtual void camera_image(std::uint64_t k, const Light& light,
                            renderer::View<std::uint8_t> image) const = 0;

  /// Sets what is on the board that is held if `twin.prop.kind` is board; before the first image.
  /// Without it the scene is empty. Errors: bad_data (check()), bad_config (the twin
  /// has hands).
  virtual Result<void> show_board(const FlatPicture& picture) = 0;
  /// The true pose camera_from_board of the board's axes (FlatPicture); empty without a board.
  virtual std::optional<glm::dmat4> board_pose(std::int64_t time_ns) const = 0;

  /// The result of one run of the detector.
  struct Detection {
    msg::Landmarks landmarks;  ///< header.origin_ns by the detector's clock; count 0 if lost
    std::int64_t age_ns = 0;   ///< time from the frame's true origin to the result
  };
  /// The result of run number `n` of the detector on the camera frame of this id and stamp. A frame
  /// that is not of the twin's camera is taken to show the hand at its stamp.
  virtual Detection detect(std::uint64_t n, std::uint64_t frame_id,
                           std::int64_t stamp_ns) const = 0;
  /// Adds the losses, outliers and faults of that run to what a real detector has found in a frame
  /// of this true time. detect() has them already.
  virtual void spoil(std::uint64_t n, std::int64_t origin_ns, msg::Landmarks& found) const = 0;
};

/// The score of the light of one frame on the true hands (`docs/method.md#metrics`). Lengths are in
/// projector px, or in mm on the surface.
struct FrameScore {
  /// A point of the surface without light counts as if its light were this far away: a finger's
  /// width.
  static constexpr float kMissing_mm = 20;
  /// The displacement of the light on a part of a hand.
  struct Part {
    glm::vec2 sum_px{0};  ///< sum over the lit points: place of the light - place it is meant for
    int points = 0;       ///< lit points
  };
  static constexpr std::size_t kParts = 6;  ///< thumb to little finger, palm

  std::int64_t display_ns = 0;  ///< time of the light, since the epoch
  /// The score of one hand.
  struct Hand {
    Side side = Side::left;          ///< which hand it is
    double speed_m_s = 0;            ///< mean speed of the visible points of the true surface
    std::vector<float> interior_px;  ///< error by lit point of the surface
    std::vector<float> interior_mm;  ///< the same errors along the surface
    std::vector<float> missing_px;   ///< kMissing_mm in px, by point without light of this hand
    int hand_px = 0;                 ///< pixels of the true hand
    int lit_px = 0;                  ///< those of them with at least half of the intended light
    int spill_px = 0;                ///< lit pixels beside hands and arms, nearest to this hand
    int union_px = 0;                ///< hand_px + spill_px: the denominator of the IoU
    double seam_px = 0;              ///< length of the edge of the light inside the true hand
    double outline_px = 0;           ///< length of the outline of the true hand
    double lag_px_s = 0;             ///< sum of -error . velocity over the lit points
    double speed2_px_s2 = 0;         ///< sum of |velocity|^2; equivalent latency = lag / speed2
    double error2_px2 = 0;           ///< sum of |error|^2
    std::array<Part, kParts> parts;  ///< for the jitter of the light
  };
  std::vector<Hand> hands;  ///< the visible hands
  int stray_px = 0;         ///< lit pixels beside hands and arms that belong to no visible hand
};

/// Scores projections against the truth. Reuses its buffers: not thread-safe.
class Judge {
 public:
  /// Creates a judge that scores surface points on a grid of about `step_px` projector pixels: the
  /// next multiple of msg::Projection::kShownStep_px. `twin` must outlive it. The sizes are those
  /// of the projector.
  static std::unique_ptr<Judge> create(const Twin& twin, int step_px);
  virtual ~Judge() = default;
  /// Scores one projection. `epoch_ns`: the twin's epoch, on the clock of the projection. Without
  /// shown points all of the surface counts as missing.
  virtual FrameScore score(const msg::Projection& projection, std::int64_t epoch_ns) = 0;
  /// Scores one whose times are ns since the twin's epoch.
  FrameScore score(const msg::Projection& projection) { return score(projection, 0); }
};

}  // namespace handcast::twin
