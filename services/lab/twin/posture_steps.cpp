// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/posture_steps.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::twin {

double wave_at(double hz, double t, double phase) { return std::sin(kTurn * (hz * t + phase)); }

double pulse_at(double hz, double t) { return 0.5 - 0.5 * std::cos(kTurn * hz * t); }

double step_at(double begin_s, double end_s, double t) {
  const double x = std::clamp((t - begin_s) / (end_s - begin_s), 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

double within(double period_s, double t) { return t - period_s * std::floor(t / period_s); }

void breathe(Posture& posture, double t) {
  posture.shift += glm::dvec3(0.008 * wave_at(0.23, t), 0.006 * wave_at(0.31, t, 0.2),
                              0.006 * wave_at(0.17, t, 0.4));
  posture.sway += 0.03 * wave_at(0.19, t, 0.1);
  posture.nod += 0.04 * wave_at(0.27, t, 0.3);
}

void curl(Bend& bend, int finger, double amount) {
  bend.flexion[finger] = {1.25 * amount, 1.65 * amount, 0.95 * amount};
}

void close_thumb(Bend& bend, double shut) {
  bend.flexion[0] = {0.6 * shut, 0.9 * shut, 0};
  bend.thumb_flexion = 0.25 * shut;
  bend.thumb_opposition = -0.2 * shut;
}

}  // namespace handcast::twin
