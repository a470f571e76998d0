// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/held_hand.hpp"

#include <cmath>

namespace handcast::calib {

glm::dvec3 middle_of(const TrackedHand& hand) {
  glm::dvec3 sum(0);
  for (const auto& joint : hand) sum += joint.at_m;
  return sum / static_cast<double>(kHandPoints);
}

TrackedHand mean_of(const std::vector<TrackedHand>& hands) {
  auto mean = hands[hands.size() / 2];
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    glm::dvec3 sum(0);
    for (const auto& hand : hands) sum += hand[i].at_m;
    mean[i].at_m = sum / static_cast<double>(hands.size());
  }
  return mean;
}

SeenHand mean_of(const std::vector<SeenHand>& hands) {
  SeenHand mean;
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    glm::dvec2 sum(0);
    double sigmas_px = 0, count = 0;
    for (const auto& hand : hands) {
      if (!(hand[i].sigma_px > 0)) continue;
      sum += hand[i].undistorted_px;
      sigmas_px += hand[i].sigma_px;
      ++count;
    }
    if (count > 0 && 2 * count >= static_cast<double>(hands.size()))
      mean[i] = {sum / count, sigmas_px / count};
  }
  return mean;
}

Unrest unrest_of(const std::vector<TrackedHand>& hands) {
  const auto mean = mean_of(hands);
  const auto middle = middle_of(mean);
  Unrest sums;
  for (const auto& hand : hands) {
    const auto off = middle_of(hand) - middle;
    sums.middle_m += glm::dot(off, off);
    for (std::size_t i = 0; i < kHandPoints; ++i) {
      const auto joint_off = hand[i].at_m - mean[i].at_m;
      sums.joints_m += glm::dot(joint_off, joint_off) / static_cast<double>(kHandPoints);
    }
  }
  const auto count = static_cast<double>(hands.size());
  return {std::sqrt(sums.middle_m / count), std::sqrt(sums.joints_m / count)};
}

}  // namespace handcast::calib
