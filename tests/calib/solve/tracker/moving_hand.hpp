// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "ipc/base/clock.hpp"

/// A hand that moves through the working volume, seen by a tracker and a camera whose poses and
/// clocks are known.
namespace handcast::calib::samples {

struct World {
  unsigned seed = 1;
  double seconds = 15;
  double camera_hz = 60, tracker_hz = 90.3;
  double sighting_px = 1;   ///< noise of each coordinate, standard deviation
  double tracker_mm = 0.5;  ///< likewise, of each point by itself
  double bias_mm = 1;       ///< root mean square length of the tracker's common error
  double bias_time_s = 2;   ///< after which it is forgotten to 1/e
  double outliers = 0.2;    ///< sightings that are anywhere in the image
  double offset_s = 0.005;  ///< the tracker's clock minus the camera's
  /// How far the hand moves to each side, and how much it rotates.
  /// @{
  glm::dvec3 reach_m{0.08, 0.08, 0.11};
  double turn_rad = 0.5;
  /// @}
  bool fingers_bend = true;
  bool only_index_tip = false;
};

struct Recording {
  CameraModel camera;
  glm::dmat4 camera_from_tracker{1};
  std::vector<TrackerSample> samples;
  std::vector<Sighting> sightings;
};

/// Where the light of a fit goes wrong at a place in camera space.
inline double error_mm(const Recording& truth, const TrackerFit& fit, const glm::dvec3& place_m) {
  const auto tracker_m = glm::inverse(truth.camera_from_tracker) * glm::dvec4(place_m, 1);
  return 1000 * glm::distance(glm::dvec3(fit.camera_from_tracker * tracker_m), place_m);
}

/// Truth minus estimate, as in TrackerFit: place of the camera (mm), rotation (deg), offset (ms).
inline std::array<double, 7> errors_of(const Recording& truth, const TrackerFit& fit,
                                       double offset_s) {
  const auto change = truth.camera_from_tracker * glm::inverse(fit.camera_from_tracker);
  return {-1000 * change[3][0],
          -1000 * change[3][1],
          -1000 * change[3][2],
          glm::degrees(change[1][2] - change[2][1]) / 2,
          glm::degrees(change[2][0] - change[0][2]) / 2,
          glm::degrees(change[0][1] - change[1][0]) / 2,
          1000 * offset_s - static_cast<double>(fit.clock_offset_ns) * 1e-6};
}

/// The middle of the hand's volume, in camera space.
constexpr glm::dvec3 kMiddle_m{0, 0, 0.725};

class MovingHand {
 public:
  explicit MovingHand(const World& world) : world_(world), random_(world.seed) {
    for (auto& wave : waves_)
      for (int axis = 0; axis < 3; ++axis) {
        wave.hz[axis] = uniform(0.15, 0.7);
        wave.phase[axis] = uniform(0, 6.28);
      }
  }

  Recording record() {
    Recording recording;
    const auto axis = glm::normalize(glm::dvec3(normal(1), normal(1), normal(1)));
    recording.camera_from_tracker =
        glm::translate(glm::dmat4(1), {uniform(-0.2, 0.2), uniform(-0.1, 0.4), uniform(0.3, 0.6)}) *
        glm::rotate(glm::dmat4(1), uniform(0, 3.1), axis);
    take_samples(recording);
    take_sightings(recording);
    return recording;
  }

  /// The 21 points (or 1) at a time, in camera space.
  std::vector<glm::dvec3> points_at(double s) const {
    const auto middle = kMiddle_m + world_.reach_m * 0.62 * (wave(0, s) + wave(1, 1.6 * s));
    const auto turn = world_.turn_rad * wave(2, s);
    auto pose = glm::translate(glm::dmat4(1), middle);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 about(0);
      about[axis] = 1;
      pose = glm::rotate(pose, turn[axis], about);
    }
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 21; ++i) points.emplace_back(pose * glm::dvec4(joint(i, s), 1));
    return world_.only_index_tip ? std::vector{points[8]} : points;
  }

 private:
  struct Wave {
    glm::dvec3 hz, phase;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal(double sd) { return sd * std::normal_distribution<double>()(random_); }
  glm::dvec3 noise(double sd) { return {normal(sd), normal(sd), normal(sd)}; }

  glm::dvec3 wave(std::size_t k, double s) const {
    return glm::sin(6.28318530718 * waves_[k].hz * s + waves_[k].phase);
  }

  /// A flat hand whose fingers bend out of its plane.
  glm::dvec3 joint(int i, double s) const {
    if (i == 0) return {0, 0.08, 0};
    const int finger = (i - 1) / 4, bone = (i - 1) % 4;
    const double bend = world_.fingers_bend ? 0.3 * (1 + std::sin(2.5 * s + finger)) * bone : 0;
    const double across = finger == 0 ? -0.045 - 0.008 * bone : 0.02 * (finger - 2.5);
    const double along = finger == 0 ? 0.05 - 0.025 * bone : -0.028 * bone * std::cos(bend / 2);
    return {across, along, -0.028 * bone * std::sin(bend / 2) + (finger == 0 ? -0.01 : 0)};
  }

  void take_samples(Recording& recording) {
    const auto tracker_from_camera = glm::inverse(recording.camera_from_tracker);
    const double step_s = 1 / world_.tracker_hz, phase_s = uniform(0, step_s);
    const double kept = std::exp(-step_s / world_.bias_time_s);
    const double bias_sd = world_.bias_mm / 1000 / std::sqrt(3.);
    auto bias_m = noise(bias_sd);
    for (double s = phase_s - 0.2; s < world_.seconds + 0.2; s += step_s) {
      bias_m = kept * bias_m + noise(bias_sd * std::sqrt(1 - kept * kept));
      TrackerSample sample{kBegin_ns + seconds_to_ns(s + world_.offset_s), {}};
      for (const auto& at : points_at(s))
        sample.points_m.push_back(glm::dvec3(tracker_from_camera * glm::dvec4(at, 1)) + bias_m +
                                  noise(world_.tracker_mm / 1000));
      recording.samples.push_back(std::move(sample));
    }
  }

  void take_sightings(Recording& recording) {
    const auto& camera = recording.camera;
    for (double s = uniform(0, 0.01); s < world_.seconds; s += 1 / world_.camera_hz) {
      const auto points = points_at(s);
      for (std::size_t p = 0; p < points.size(); ++p) {
        auto px = camera.project(points[p]) +
                  glm::dvec2(normal(world_.sighting_px), normal(world_.sighting_px));
        if (uniform(0, 1) < world_.outliers)
          px = {uniform(0, camera.width_px), uniform(0, camera.height_px)};
        if (px.x < 0 || px.y < 0 || px.x >= camera.width_px || px.y >= camera.height_px) continue;
        recording.sightings.push_back({kBegin_ns + seconds_to_ns(s), static_cast<int>(p), px,
                                       std::max(world_.sighting_px, 0.1)});
      }
    }
  }

  static constexpr std::int64_t kBegin_ns = 1'000'000'000'000;

  World world_;
  std::mt19937 random_;
  std::array<Wave, 3> waves_;
};

inline Recording record(const World& world) { return MovingHand(world).record(); }

}  // namespace handcast::calib::samples
