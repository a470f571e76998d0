// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/second_light.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace handcast::simulate {
namespace {

using config::Viewpoint;

/// Draws as often as the first projector, of whose frames every `draw_every`-th is drawn.
int as_often(const config::Rig& rig, int draw_every) {
  const double frames = draw_every * rig.projector2.rate_hz / rig.projector.rate_hz;
  return std::max(1, static_cast<int>(std::lround(frames)));
}

bool is_white(const config::Content& content) {
  return content.left == "builtin:white" && content.right == "builtin:white";
}

}  // namespace

Result<std::unique_ptr<SecondLight>> SecondLight::open(const config::Rig& rig,
                                                       const calib::Calibration& calibration,
                                                       const Options& options,
                                                       const twin::Twin& twin) {
  auto parts = open_virtual_rig(rig, calibration, options, Viewpoint::second);
  if (!parts) return tl::make_unexpected(parts.error());
  return std::unique_ptr<SecondLight>(
      new SecondLight(rig, calibration, options, twin, std::move(*parts)));
}

SecondLight::SecondLight(const config::Rig& rig, const calib::Calibration& calibration,
                         const Options& options, const twin::Twin& twin, VirtualRig parts)
    : parts_(std::move(parts)),
      feed_(make_twin_feed(*parts_.twin, std::move(parts_.detector), {}, parts_.lifter,
                           parts_.second, parts_.sent)),
      simulation_(config::rig_at_projector(rig, Viewpoint::second),
                  calib::at_projector(calibration, Viewpoint::second), *parts_.pipeline, *feed_,
                  as_often(rig, options.draw_every)),
      judge_(twin, is_white(rig.content)) {}

void SecondLight::judge(const msg::Projection& first, std::int64_t now_ns) {
  while (simulation_.now_ns() <= now_ns)
    simulation_.step([this](const Tick& tick) {
      if (tick.projection) newest_ = tick.projection;
    });
  if (newest_) judge_.add(first, *newest_);
}

nlohmann::json SecondLight::to_json() const { return judge_.to_json(); }

}  // namespace handcast::simulate
