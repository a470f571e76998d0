// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "calib/drift/drift_watch.hpp"
#include "ipc/base/clock.hpp"

/// A hand that is held still at one place after the other, in front of a rig whose tracker may have
/// moved.
namespace handcast::calib::samples {

struct Rig {
  unsigned seed = 1;
  double moved_mm = 0, turned_deg = 0;  ///< of the tracker, since the calibration
  double joints_mm = 3;  ///< how far the detector's joints are from the tracker's, by person
  double noise_px = 2;
  double sway_m_s = 0;           ///< speed of the hand while it is held
  bool always_the_same = false;  ///< the hand is never turned
  double begin_s = 10;
};

/// Shows places to a watch. One person.
class HeldPlaces {
 public:
  explicit HeldPlaces(const Rig& rig) : rig_(rig), random_(rig.seed), time_s_(rig.begin_s) {
    calibration_.camera_from_tracker = glm::translate(
        glm::rotate(glm::dmat4(1), 2.0, glm::normalize(glm::dvec3(1, 0.2, 0.3))), {0.1, 0.2, -0.3});
    const auto away = glm::normalize(glm::dvec3(uniform(), uniform(), 0)),
               axis = glm::normalize(glm::dvec3(uniform(), uniform(), uniform()));
    const glm::dvec3 middle(0, 0, 0.73);
    motion_ = glm::translate(glm::dmat4(1), middle + away * rig.moved_mm * 1e-3) *
              glm::rotate(glm::dmat4(1), glm::radians(rig.turned_deg), axis) *
              glm::translate(glm::dmat4(1), -middle);
    new_person();
  }

  const Calibration& calibration() const { return calibration_; }
  /// The true motion of the tracker, in camera space.
  const glm::dmat4& motion() const { return motion_; }

  void new_person() {
    for (auto& offset : joints_m_)
      offset = rig_.joints_mm * 1e-3 / 1.7 * glm::dvec3(normal(), normal(), normal());
    time_s_ += 3;
  }

  /// Holds the hand at a new place for 0.8 s.
  void hold(DriftWatch& watch) {
    const glm::dvec3 middle(0.08 * uniform(), 0.06 * uniform(), 0.73 + 0.08 * uniform());
    auto place = glm::translate(glm::dmat4(1), middle);
    if (!rig_.always_the_same)
      for (int i = 0; i < 3; ++i) {
        glm::dvec3 axis(0);
        axis[i] = 1;
        place = glm::rotate(place, (i == 1 ? 1.0 : 0.5) * uniform(), axis);
      }
    const double begin_s = time_s_ += 0.3;
    for (; time_s_ < begin_s + 0.8; time_s_ += 0.01) show(watch, place, time_s_ - begin_s);
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  double normal() { return std::normal_distribution<double>()(random_); }

  /// In the axes of the hand: fingers along -z.
  static glm::dvec3 joint(std::size_t i) {
    if (i == 0) return {0, 0, 0.08};
    const auto finger = static_cast<double>((i - 1) / 4), bone = static_cast<double>((i - 1) % 4);
    return {0.02 * (finger - 2), 0.004 * bone * finger, -0.028 * bone};
  }

  /// One sample of the tracker, and every other time one image, 20 ms old.
  void show(DriftWatch& watch, const glm::dmat4& place, double held_s) {
    TrackedHand tracked;
    SeenHand seen;
    const auto swayed =
        glm::translate(glm::dmat4(1), glm::dvec3(rig_.sway_m_s * held_s, 0, 0)) * place;
    const auto tracker_from_camera = glm::inverse(motion_ * calibration_.camera_from_tracker);
    for (std::size_t i = 0; i < kHandPoints; ++i) {
      const auto at = glm::dvec3(swayed * glm::dvec4(joint(i), 1));
      tracked[i] = {glm::dvec3(tracker_from_camera * glm::dvec4(at, 1)) +
                        0.0002 * glm::dvec3(normal(), normal(), normal()),
                    glm::dmat3(tracker_from_camera * swayed)};
      seen[i] = {calibration_.camera.project(at + glm::dmat3(swayed) * joints_m_[i]) +
                     rig_.noise_px * glm::dvec2(normal(), normal()),
                 2};
    }
    const auto time_ns = seconds_to_ns(time_s_);
    watch.add(0, time_ns, tracked);
    if (++shown_ % 2 == 0) watch.add(0, before_ns_, before_);
    before_ = seen;
    before_ns_ = time_ns;
  }

  Rig rig_;
  std::mt19937 random_;
  Calibration calibration_ = reference_rig();
  glm::dmat4 motion_{1};
  std::array<glm::dvec3, kHandPoints> joints_m_{};
  double time_s_;
  int shown_ = 0;
  SeenHand before_;
  std::int64_t before_ns_ = 0;
};

}  // namespace handcast::calib::samples
