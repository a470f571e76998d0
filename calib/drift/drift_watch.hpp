// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "calib/drift/drift_fit.hpp"
#include "calib/drift/still_hands.hpp"

namespace handcast::calib {

/// When a drift is worth a warning.
struct DriftLimits {
  double warn_mm = 3;     ///< across the camera's axis
  double warn_deg = 0.6;  ///< about any axis
};

/// Where the tracker seems to be now, relative to the calibration.
struct Drift {
  int places = 0;           ///< at which hands were held still
  bool moved = false;       ///< beyond the limits, and beyond doubt
  double across_mm = 0;     ///< shift of the middle of the volume across the camera's axis
  double turn_deg = 0;      ///< angle of the rotation
  double across_sd_mm = 0;  ///< standard deviations
  double turn_sd_deg = 0;
  double evidence = 0;  ///< square of the drift in standard deviations: 5, on average, without one
  glm::dvec3 pivot_m{0};   ///< the middle of the volume: camera space
  glm::dvec3 shift_m{0};   ///< of the pivot
  glm::dvec3 turn_rad{0};  ///< rotation vector about the pivot
};

/// Watches hands that are held still, and compares tracker and camera with the calibration. A
/// person's hand and its joints, and a detector's idea of them, are told from a moved tracker as
/// DriftFit describes; of several persons the later ones count more. Nothing is learned while a
/// hand moves. One thread; a call takes up to a millisecond, and most take microseconds.
class DriftWatch {
 public:
  /// Copies its arguments.
  explicit DriftWatch(const Calibration& calibration, const DriftLimits& limits = {});

  /// Adds a sample of the tracker. `side`: 0 or 1.
  void add(std::size_t side, std::int64_t time_ns, const TrackedHand& hand);
  /// Adds the landmarks of an image, a little later than the tracker's samples of its time. True:
  /// drift() is new.
  bool add(std::size_t side, std::int64_t time_ns, const SeenHand& seen);

  /// What is known so far.
  const Drift& drift() const { return drift_; }

 private:
  struct Hand {
    StillHands still;
    std::optional<DriftFit> fit;  ///< of this person
  };
  void part_with_persons(std::int64_t time_ns);
  KnownMotion of_persons() const;
  void judge();

  Calibration calibration_;
  DriftLimits limits_;
  std::array<Hand, 2> hands_;
  KnownMotion past_;                   ///< of earlier persons
  std::optional<glm::dvec3> pivot_m_;  ///< of the fits: the first place
  glm::dvec3 places_m_{0};             ///< sum of all places, camera space
  Drift drift_;
};

}  // namespace handcast::calib
