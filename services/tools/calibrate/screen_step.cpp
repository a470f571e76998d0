// SPDX-License-Identifier: Apache-2.0
// Where the projector's pixels fall.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/solve/screen/depth_error.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/number_text.hpp"
#include "ipc/base/statistics.hpp"
#include "services/tools/calibrate/by_hand.hpp"
#include "services/tools/calibrate/gamma.hpp"
#include "services/tools/calibrate/light_delay.hpp"
#include "services/tools/calibrate/screen_views.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

constexpr double kGood_px = 1;  ///< error of what a good fit has not seen, median

double mean_depth_m(std::span<const calib::DepthView> views) {
  double sum = 0;
  for (const auto& view : views) sum += -view.plane.w / view.plane.z;  // on the camera's axis
  return sum / static_cast<double>(views.size());
}

std::string place_of(const calib::ScreenFit& fit) {
  if (fit.coaxial) return "coaxial";
  if (!fit.baseline) return "not coaxial";
  return fmt::format("the projector is {:.0f} mm from the camera, +- {:.0f}",
                     fit.baseline->length_mm, fit.baseline->interval_mm);
}

/// What a person can change about the light in the camera's images.
std::vector<std::string> light_findings(const LightSeen& light) {
  constexpr double kMuchSaturated = 0.05, kWeak = 25;
  std::vector<std::string> findings;
  if (light.saturated_share > kMuchSaturated)
    findings.push_back(
        fmt::format("{:.0f} % of the lit board is saturated in the camera: shorten "
                    "camera.exposure_ms, or lower projector.brightness, and measure again",
                    100 * light.saturated_share));
  else if (light.contrast < kWeak)
    findings.push_back(
        fmt::format("full light is only {:.0f} grey levels on the board: a longer "
                    "camera.exposure_ms, or a darker room, makes this step more accurate",
                    light.contrast));
  findings.push_back(fmt::format(
      "the camera sees the projector: full light is {:.0f} grey levels on white. During "
      "the show the picture on the hand is in the camera's image, too, where it "
      "disturbs the mask; an infrared-pass filter after this step keeps it out",
      light.contrast));
  return findings;
}

/// By how many projector pixels one homography for all depths would miss.
Picture errors_of(const calib::ScreenFit& fit, const calib::CameraModel& camera) {
  const std::array depths_m{fit.depths_m[0], fit.model.plane_m, fit.depths_m[1]};
  auto errors = calib::coaxial_error(fit.model, camera, depths_m);
  return {"depths",
          "By how many projector pixels one homography for all depths would miss. The calibration "
          "has the parallax, and does not.",
          {{"grid", {static_cast<double>(errors.columns), static_cast<double>(errors.rows)}},
           {"depth_m", std::move(errors.depths_m)},
           {"error_px", std::move(errors.error_px)}}};
}

/// Where the light was measured, and what one homography would miss.
std::vector<Picture> pictures_of(const Desk& desk, std::span<const calib::DepthView> views,
                                 const calib::ScreenFit& fit) {
  std::vector<glm::dvec2> dots_px;
  for (const auto& view : views)
    for (const auto& point : view.points) dots_px.push_back(point.camera_px);
  const auto& camera = desk.draft.camera;
  std::vector<Picture> pictures{dots_picture(
      camera.width_px, camera.height_px, dots_px,
      "Where the projector's light was measured; elsewhere the model is extrapolated.")};
  if (!fit.coaxial) pictures.push_back(errors_of(fit, camera));
  return pictures;
}

/// The findings about what was seen, after those of the fit.
void add_findings(const ScreenViews& measurement, Outcome& outcome) {
  for (auto& finding : light_findings(measurement.light()))
    outcome.findings.push_back(std::move(finding));
  if (const auto empty = measurement.seen().with_fewer_than(1); !empty.empty())
    outcome.findings.push_back(
        fmt::format("no light was measured in these parts of the camera's image: {}; there the "
                    "model is extrapolated",
                    fmt::join(empty, ", ")));
  if (measurement.repeated() > 0)
    outcome.findings.push_back(fmt::format("{} patterns were shown again; the last one was {}",
                                           measurement.repeated(), measurement.why_repeated()));
}

/// The projector by the views; sets that of the draft.
Result<Outcome> fit_views(Desk& desk, std::span<const calib::DepthView> views) {
  const auto fit = calib::fit_screen(views, desk.draft.camera, mean_depth_m(views),
                                     {desk.screen.width_px(), desk.screen.height_px()});
  if (!fit) return tl::make_unexpected(fit.error());
  desk.draft.projector.from_camera = fit->model.from_camera;
  desk.draft.projector.parallax = fit->model.parallax;
  desk.draft.projector.plane_m = fit->model.plane_m;
  const double held_out_px =
      fit->coaxial ? fit->held_out_coaxial.median : fit->held_out_full.median;
  Outcome outcome{fmt::format("{} places of the board, {:.2f} px held out, {}", views.size(),
                              held_out_px, place_of(*fit)),
                  held_out_px <= kGood_px, fit->findings, pictures_of(desk, views, *fit)};
  outcome.meaning = fmt::format(
      "Held out: how far the light is from where a fit that has not seen it expects it, in pixels "
      "of the projector, median; good is at most {} px",
      kGood_px);
  return outcome;
}

/// By structured light on a board that stands still at several distances; by hand if the camera
/// does not see the light. Sets the projector of the draft. Needs the lens. Errors: those of
/// calib::fit_screen() and of the streams.
Result<Outcome> measure_screen(Desk& desk) {
  auto patterns = PatternImages::open(desk);
  if (!patterns) return tl::make_unexpected(patterns.error());
  fmt::print(stderr, "  measuring the delay of the light\n");
  const auto delay = patterns->measure_delay();
  if (!delay && delay.error().code == Errc::bad_data) {
    fmt::print(stderr, "  {}\n", printable(delay.error().what));
    return align_by_hand(desk);
  }
  if (!delay) return tl::make_unexpected(delay.error());
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  ScreenViews measurement(desk, std::move(*frames), *patterns);
  const auto views = measurement.take();
  if (!views) return tl::make_unexpected(views.error());
  auto outcome = fit_views(desk, *views);
  if (!outcome) return outcome;
  add_findings(measurement, *outcome);
  report_delay(desk.rig, *delay, *outcome);
  fmt::print(stderr, "  measuring the gamma of the projector\n");
  if (auto measured = measure_gamma(desk, *patterns, *outcome); !measured)
    return tl::make_unexpected(measured.error());
  return outcome;
}

constexpr double kUnmoved_px = 0.7;  ///< structured light on one board is right within 0.2 px

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
    const auto off = used.projector.pixel_of(px, depth_m) - point.projector_px;
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

/// Compares the projector of the calibration in use with where a board that is held still shows its
/// light now. If the camera does not see the light, a finding says so. Errors: bad_data (no board
/// was held still, or it was not read), those of the streams and of the rig.
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
                  off.median_px <= kUnmoved_px};
  if (!outcome.is_good)
    outcome.findings.push_back(
        "camera or projector have moved since they were calibrated: measure the step `screen` "
        "again");
  return outcome;
}

std::vector<std::string> scene(const Options& options, double camera_hz) {
  // All patterns must be seen while it is still.
  auto settings = board_scene(options, std::clamp(6 + 240 / camera_hz, 8.0, 60.0));
  settings.insert(settings.end(), {"twin.image.leak=1", "twin.image.gain=80"});
  return settings;
}

const char* instruct(const Options& options) {
  return options.check ? "Hold or stand the board in the projector's light, still."
                       : "Hold or stand the board in the projector's light, still until it asks "
                         "for the next place: at three or more distances.";
}

}  // namespace

const StepEntry kScreenStep{.step = Step::screen,
                            .made = &calib::Made::screen,
                            .scene = scene,
                            .instruct = instruct,
                            .measure = measure_screen,
                            .check = check_screen};

}  // namespace handcast::calibrate
