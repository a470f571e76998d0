// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Cholesky>
#include <array>

#include "calib/calibration.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/estimate/abruptness.hpp"
#include "renderer/estimate/articulated_hand.hpp"
#include "renderer/estimate/error_priors.hpp"
#include "renderer/estimate/hand_errors.hpp"

namespace handcast::renderer {

/// The estimate of all errors: an extended Kalman filter (Jazwinski 1970, section 8.3) whose
/// outliers count less (Huber 1964). See `docs/method.md#estimate`. All memory is allocated
/// at the start. One thread.
class ErrorFilter {
 public:
  /// All errors are 0, with the variances of their priors.
  ErrorFilter();

  /// Lets time pass: what is known of errors that change becomes less certain. `flexions`: those of
  /// the tracker's fingers; folded ones hide their errors. `rest`: see Sighting; a detector errs in
  /// the same way as long as it sees the same.
  void pass(double seconds, const Flexions& flexions, float rest);
  /// The tracker has bent fingers that have not moved: they are as much too bent from now on.
  void unbend(const Flexions& snapped_rad);
  /// Forgets where the tracker puts the hand and how it bends the fingers, not the person's joints.
  void forget_place();
  /// Adds the landmarks of an image (undistorted px) and the tracker's hand at the same time.
  /// Returns false, and learns nothing, if most landmarks are where that hand cannot be.
  bool update(const calib::CameraModel& camera, const HandJoints& reported,
              const msg::HandLandmarks& seen, AbruptLandmarks abrupt);

  /// How unlikely the errors are before anything is seen: the sum of their squares, in the
  /// variances of their priors.
  double surprise() const;

  /// The tracker's errors that are expected after a time in which nothing is seen.
  HandErrors errors_after(double seconds) const;

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  void begin();
  /// The share of each error that is left after a time.
  HandErrors kept_after(double seconds) const;
  void set_variance(const ErrorPrior& prior);
  void add_bends(int finger, double share);
  void set_noise(const msg::HandLandmarks& seen);
  void learn_sigma(const calib::CameraModel& camera, const HandJoints& reported);
  HandErrors of_tracker(HandErrors errors) const;
  void linearise(const calib::CameraModel& camera, const HandJoints& reported,
                 const msg::HandLandmarks& seen);
  void add_slopes(int landmark, const glm::dmat3x2& px_per_m, const ArticulatedHand& hand);
  void expect(const calib::CameraModel& camera, const HandJoints& reported,
              const msg::HandLandmarks& seen);
  bool is_seen(int landmark) const;
  double deviation(int landmark) const;
  bool is_contradicted() const;
  bool free_fingers(const AbruptLandmarks& abrupt);
  bool end_errors(AbruptLandmarks& abrupt);
  bool end_opposite_errors();
  void end_error(const ErrorPrior& prior);
  void doubt_landmarks(const AbruptLandmarks& abrupt);
  void reduce_covariance();

  HandErrors errors_{};
  Matrix covariance_;
  std::array<double, kLandmarks> sigma_px_;  ///< of the newest landmarks
  double seen_s_ = kSeen_s;                  ///< how long its errors last
  double usual_sigma_m_ = 0;                 ///< of the detector, on the hand; 0: nothing was seen

  /// Work of an update, by number of a detection: its noise, its distance from what is expected,
  /// the covariance of that, its derivatives, and the covariance of the errors times them.
  /// @{
  Vector noise_, residual_;
  Matrix expected_, slopes_, spread_, whitened_;
  Eigen::LLT<Matrix> root_;
  /// @}
};

}  // namespace handcast::renderer
