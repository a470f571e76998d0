// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "ipc/msg/landmarks.hpp"
#include "services/lab/simulate/frame_detector.hpp"

namespace handcast::simulate {

/// How long the errors of a detector last: the autocorrelation of the error of each landmark, about
/// zero, over all landmarks: sum e(t) e(t + d) / sum (|e(t)|^2 + |e(t + d)|^2) / 2. White noise has
/// 0, a constant error 1.
class ErrorMemory {
 public:
  /// The error of each landmark of one hand in px; NaN if it was not seen.
  using Errors = std::array<glm::vec2, msg::kLandmarks>;

  /// Adds the errors of a frame of `time_ns`. Times must ascend per side.
  void add(msg::Side side, std::int64_t time_ns, const Errors& errors);

  /// {"50": 0.9, ...}: by delay in ms (50, 100, 200, 400); null if there are no such pairs.
  nlohmann::json to_json() const;

 private:
  struct Entry {
    std::int64_t time_ns;
    Errors errors;
  };
  std::array<std::vector<Entry>, 2> entries_;
};

/// Accuracy of a detector: its detections compared with the truth at the time of each frame. The
/// time stamps of the detections are ignored: a clock error is not an error of the points.
class DetectorTally {
 public:
  /// `twin` must outlive the object; `camera` is copied.
  DetectorTally(const twin::Twin& twin, const calib::CameraModel& camera)
      : twin_(twin), camera_(camera) {}

  /// Adds the detection of one frame.
  void add(const Exposure& exposure, const Detection& detection);

  /// {"runs", "hands", "missed", "invented", "error_px": {mean, p50, p95, autocorrelation},
  /// "ms_p50"}; a value that was not measured is null.
  ///
  /// - hands: true hands with at least half of their landmarks in the image
  /// - missed: those of them that were not found
  /// - invented: hands that were found although there is no hand of that side
  /// - error_px: error of the landmarks in the image, of the hands that were found
  /// - autocorrelation: ErrorMemory
  /// - ms_p50: median time of a run on this machine
  nlohmann::json to_json() const;

 private:
  /// Counts of values from 0 to 100; larger values count as 100.
  class Histogram {
   public:
    void add(double value);
    nlohmann::json mean() const;
    nlohmann::json percentile(double share) const;

   private:
    static constexpr double kSteps = 50;  ///< steps per unit
    std::array<std::uint32_t, 5001> counts_{};
    std::size_t count_ = 0;
    double sum_ = 0;
  };
  void add_hand(msg::Side side, std::int64_t time_ns, const msg::HandLandmarks* found);
  bool in_image(glm::vec2 undistorted_px) const;

  const twin::Twin& twin_;
  calib::CameraModel camera_;
  std::int64_t runs_ = 0, hands_ = 0, missed_ = 0, invented_ = 0;
  Histogram error_px_, work_ms_;
  ErrorMemory memory_;
};

}  // namespace handcast::simulate
