// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "services/studies/jnd/course.hpp"

namespace handcast::study {

/// A simulated subject: the model of a viewer with a JND of its own, and now and then a blind
/// answer.
class SimulatedSubject {
 public:
  /// Draws a subject. `jnd_ms`: of the model, by condition, the mean of all subjects.
  SimulatedSubject(std::array<double, 2> jnd_ms, std::uint64_t seed, int number);

  /// The delay with 75 % right answers but for blind ones, ms.
  double jnd_ms(Condition condition) const { return jnd_ms_[static_cast<std::size_t>(condition)]; }
  Answer answer(const Trial& trial);

 private:
  std::array<double, 2> jnd_ms_;
  std::uint64_t seed_, answers_ = 0;
};

/// The JNDs that the model of a viewer predicts for a motion, by condition.
std::array<double, 2> predicted_jnds_ms(std::span<const double> speeds_deg_s);

/// Lets `count` simulated subjects take the course with each procedure, and reports what comes out
/// against what is true: see docs/studies.md#simulated.
nlohmann::json simulate_subjects(std::array<double, 2> jnd_ms, int count, std::uint64_t seed);

}  // namespace handcast::study
