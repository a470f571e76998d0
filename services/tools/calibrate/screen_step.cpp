// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/screen_step.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "calib/solve/screen/depth_error.hpp"
#include "services/tools/calibrate/by_hand.hpp"
#include "services/tools/calibrate/delay_report.hpp"
#include "services/tools/calibrate/gamma_step.hpp"
#include "services/tools/calibrate/pictures.hpp"
#include "services/tools/calibrate/screen_views.hpp"

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

/// Where the light was measured, and what one homography would miss.
std::string pictures_of(const Desk& desk, std::span<const calib::DepthView> views,
                        const calib::ScreenFit& fit) {
  std::vector<glm::dvec2> dots_px;
  for (const auto& view : views)
    for (const auto& point : view.points) dots_px.push_back(point.camera_px);
  const auto& camera = desk.draft.camera;
  auto html =
      dots_svg(camera.width_px, camera.height_px, dots_px,
               "Where the projector's light was measured; elsewhere the model is extrapolated.");
  if (fit.coaxial) return html;
  const std::array depths_m{fit.depths_m[0], fit.model.plane_m, fit.depths_m[1]};
  return html + errors_svg(calib::coaxial_error(fit.model, camera, depths_m),
                           "By how many projector pixels one homography for all depths would miss. "
                           "The calibration has the parallax, and does not.");
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
  desk.draft.projector_from_camera = fit->model.projector_from_camera;
  desk.draft.parallax = fit->model.parallax;
  desk.draft.plane_m = fit->model.plane_m;
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

}  // namespace

Result<Outcome> measure_screen(Desk& desk) {
  auto patterns = PatternImages::open(desk);
  if (!patterns) return tl::make_unexpected(patterns.error());
  fmt::print(stderr, "  measuring the delay of the light\n");
  const auto delay = patterns->measure_delay();
  if (!delay && delay.error().code == Errc::bad_data) {
    fmt::print(stderr, "  {}\n", delay.error().what);
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

}  // namespace handcast::calibrate
