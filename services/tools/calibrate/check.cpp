// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/number_text.hpp"
#include "services/tools/calibrate/screen_views.hpp"

namespace handcast::calibrate {
namespace {

constexpr double kGood_px = 0.7;  ///< structured light on one board is right within 0.2 px

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// By how many projector pixels the calibration is off on a board.
struct Off {
  double median_px = 0, depth_m = 0;
  glm::dvec2 shift_px{0};  ///< medians: where the light is, relative to where it should be
};

Off off_of(const calib::Calibration& used, const calib::DepthView& view) {
  std::vector<double> off_px, right_px, down_px, depths_m;
  for (const auto& point : view.points) {
    const auto px = used.camera.undistort(point.camera_px);
    const glm::dvec3 ray((px.x - used.camera.cx_px) / used.camera.fx_px,
                         (px.y - used.camera.cy_px) / used.camera.fy_px, 1);
    const double depth_m = -view.plane.w / glm::dot(glm::dvec3(view.plane), ray);
    if (!(depth_m > 0)) continue;
    const auto off = used.to_projector(px, depth_m) - point.projector_px;
    off_px.push_back(glm::length(off));
    right_px.push_back(off.x);
    down_px.push_back(off.y);
    depths_m.push_back(depth_m);
  }
  if (off_px.empty()) return {};
  return {median(off_px), median(depths_m), {median(right_px), median(down_px)}};
}

/// "0.3 px to the left, 1.2 px down", for what does not round to zero.
std::string direction_of(const glm::dvec2& shift_px) {
  const auto part = [](double px, const char* forward, const char* backward) {
    const auto length = number_text(std::abs(px), 1);
    return length == "0.0" ? std::string()
                           : fmt::format("{} px {}", length, px > 0 ? forward : backward);
  };
  const auto across = part(shift_px.x, "to the right", "to the left"),
             along = part(shift_px.y, "down", "up");
  if (across.empty() && along.empty()) return "to no side";
  return across + (across.empty() || along.empty() ? "" : ", ") + along;
}

}  // namespace

Result<Outcome> check_screen(Desk& desk) {
  auto patterns = PatternImages::open(desk);
  if (!patterns) return tl::make_unexpected(patterns.error());
  const auto delay = patterns->measure_delay_roughly();
  if (!delay && delay.error().code == Errc::bad_data)
    return Outcome{.made = "the projector's place was not checked",
                   .findings = {delay.error().what},
                   .is_checked = false};
  if (!delay) return tl::make_unexpected(delay.error());
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  ScreenViews measurement(desk, std::move(*frames), *patterns);
  const auto views = measurement.take(1);
  if (!views) return tl::make_unexpected(views.error());
  const auto off = off_of(desk.used, views->front());
  const double off_mm = off.median_px * desk.used.mm_per_projector_px(off.depth_m);
  Outcome outcome{fmt::format("at {:.2f} m the light is off by {:.1f} px ({:.1f} mm): {}",
                              off.depth_m, off.median_px, off_mm, direction_of(off.shift_px)),
                  off.median_px <= kGood_px};
  if (!outcome.is_good)
    outcome.findings.push_back(
        "camera or projector have moved since they were calibrated: measure the step `screen` "
        "again");
  return outcome;
}

}  // namespace handcast::calibrate
