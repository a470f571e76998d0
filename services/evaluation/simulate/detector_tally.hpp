// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "services/evaluation/simulate/frame_detector.hpp"

namespace handcast::simulate {

/// How a detector fared against the truth at each frame's time. Time stamps do not count: a skewed
/// clock is no error of the points.
class DetectorTally {
 public:
  DetectorTally(const twin::Twin& twin, const calib::CameraModel& camera)
      : twin_(twin), camera_(camera) {}

  void add(const Exposure& exposure, const Detection& detection);

  /// {"runs","hands": those in sight, of which at least half the landmarks are in the
  /// image,"missed": of these,"invented": found where
  ///  there is no hand of that side,"error_px":{mean,p50,p95} of the landmarks in the image of
  ///  hands that were found,"ms_p50": of this machine}. What was never measured is null.
  nlohmann::json to_json() const;

 private:
  /// 0 to 100 in equal steps; what is above counts as 100.
  class Histogram {
   public:
    void add(double value);
    nlohmann::json mean() const;
    nlohmann::json percentile(double share) const;

   private:
    static constexpr double kSteps = 50;  ///< for each one
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
};

}  // namespace handcast::simulate
