// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/light_moment.hpp"

#include <algorithm>
#include <numeric>

#include "ipc/base/clock.hpp"

namespace handcast::simulate {
namespace {

bool has_dark_hand(const Tick& tick, const twin::Twin& twin) {
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const bool lit = std::ranges::any_of(
        tick.hands, [side](const renderer::FrameHand& hand) { return hand.side == side; });
    if (!lit && twin.landmarks(side, tick.target_ns)) return true;
  }
  return false;
}

}  // namespace

double LandmarkErrors::mean_mm() const {
  return std::accumulate(mm.begin(), mm.end(), 0.0) / static_cast<double>(mm.size());
}

std::optional<LandmarkErrors> landmark_errors(const renderer::FrameHand& hand,
                                              std::int64_t display_ns, const twin::Twin& twin,
                                              const calib::Calibration& calibration) {
  const auto truth = twin.landmarks(hand.side, display_ns);
  const auto joints = twin.joints(hand.side, display_ns);
  if (!truth || !joints) return std::nullopt;
  LandmarkErrors errors;
  for (std::size_t i = 0; i < truth->size(); ++i) {
    const glm::dvec3 true_place_m =
        calibration.camera_from_tracker * (*joints)[msg::kJointOfLandmark[i]][3];
    errors.px[i] = glm::length(hand.corrected[i] - (*truth)[i]);
    errors.mm[i] = 1e3 * errors.px[i] * true_place_m.z / calibration.camera.fx_px;
  }
  return errors;
}

LightMoment moment_of(const Tick& tick, int detections, const twin::Twin& twin,
                      const calib::Calibration& calibration) {
  LightMoment moment{ns_to_seconds(tick.target_ns), 0, has_dark_hand(tick, twin), detections};
  for (const auto& hand : tick.hands)
    if (const auto errors = landmark_errors(hand, tick.target_ns, twin, calibration))
      moment.error_mm = std::max(moment.error_mm, errors->mean_mm());
  return moment;
}

}  // namespace handcast::simulate
