// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pair_step.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

#include "calib/solve/pair/pair_off.hpp"
#include "services/tools/calibrate/lens_step.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

/// What a good fit stays below: the errors of what it has not seen, and of the middle of the
/// volume.
/// @{
constexpr double kGood_px = 0.8, kGood_mm = 3;
constexpr double kGoodMiddle_mm = 10;
/// @}

/// A lens of the draft, and how well it is known.
calib::KnownLens known_lens(const Desk& desk, const std::string& step,
                            const calib::CameraModel& camera, Outcome& outcome) {
  const auto covariance = recall_lens(desk.options.folder, step, camera);
  if (!covariance)
    outcome.findings.push_back(
        fmt::format("the error of the lens `{}` is not known, since it was not measured here: the "
                    "+- leave it out",
                    step));
  return {camera, covariance.value_or(calib::LensCovariance{})};
}

Picture picture_of(const calib::CameraModel& camera, std::span<const calib::PairView> views,
                   calib::BoardView calib::PairView::*image, std::string_view which) {
  std::vector<glm::dvec2> dots;
  for (const auto& view : views)
    dots.insert(dots.end(), (view.*image).image_px.begin(), (view.*image).image_px.end());
  return dots_picture(camera.width_px, camera.height_px, dots,
                      fmt::format("Where the {} camera saw the board: {} corners in {} images.",
                                  which, dots.size(), views.size()));
}

std::string half_widths(const std::array<calib::Spread, 3>& spreads, const char* unit) {
  const auto half = [](const calib::Spread& spread) { return (spread.high - spread.low) / 2; };
  return fmt::format("{:.2f} {:.2f} {:.2f} {}", half(spreads[0]), half(spreads[1]),
                     half(spreads[2]), unit);
}

void describe(const calib::PairFit& fit, Outcome& outcome) {
  const auto& apart = fit.apart_mm;
  outcome.made = fmt::format(
      "{} views, {:.2f} px from epipolar lines and {:.1f} mm on the board held out; the cameras "
      "are {:.1f} mm apart +- {:.1f}; the middle of the volume is known to {:.1f} mm",
      fit.views.size(), fit.held_out_px, fit.held_out_mm, (apart.low + apart.high) / 2,
      (apart.high - apart.low) / 2, fit.middle_mm);
  for (std::size_t i = 0; i < fit.views.size(); ++i)
    if (!fit.views[i].rejected.empty())
      outcome.findings.push_back(
          fmt::format("view {} was left out: {}", i + 1, fit.views[i].rejected));
  outcome.findings.push_back(fmt::format(
      "95 % intervals of the second camera right, down and forward of the first: +- {}; "
      "of its rotation about these: +- {}",
      half_widths(fit.place_mm, "mm"), half_widths(fit.turn_deg, "degrees")));
  outcome.meaning = fmt::format(
      "Held out: of views that the fit has not seen; good are at most {} px and {} mm. The middle "
      "of the volume: 95 % of the fits have it within this; good is at most {} mm",
      kGood_px, kGood_mm, kGoodMiddle_mm);
  outcome.is_good =
      fit.held_out_px <= kGood_px && fit.held_out_mm <= kGood_mm && fit.middle_mm <= kGoodMiddle_mm;
  if (!outcome.is_good)
    outcome.findings.insert(
        outcome.findings.begin(),
        "the second camera's place is not well known yet: were the lenses measured with these "
        "cameras, was the board still, and was it held near and far?");
}

/// From a board that both cameras see; sets draft.camera2->from_camera. The lenses are those of the
/// draft. Errors: bad_config (the rig has one camera), those of take_pair_views() and
/// calib::fit_pair().
Result<Outcome> measure_pair(Desk& desk) {
  auto& second = desk.draft.camera2;
  if (!second) return fail(Errc::bad_config, "the rig has no second camera");
  const auto seen = take_pair_views(desk, PairWanted::places);
  if (!seen) return tl::make_unexpected(seen.error());
  const auto& views = seen->views;
  Outcome outcome;
  const calib::KnownLenses lenses{known_lens(desk, "lens", desk.draft.camera, outcome),
                                  known_lens(desk, "lens2", second->camera, outcome)};
  const auto fit = calib::fit_pair(views, lenses);
  if (!fit) return tl::make_unexpected(fit.error());
  second->from_camera = fit->second_from_first;
  describe(*fit, outcome);
  outcome.pictures = {
      picture_of(desk.draft.camera, views, &calib::PairView::first, "first"),
      picture_of(second->camera, views, &calib::PairView::second, "second"),
      errors_picture(fit->views,
                     "How far the corners of each view are from where the fit has them in both "
                     "images.")};
  return outcome;
}

/// A camera has moved if a board is off by more than this. A pair that was just calibrated is right
/// within 0.8 px and 3 mm. Far away, or with cameras close together, kMovedAlong_mm is less than
/// images tell: there, it must also be kMoved_px.
/// @{
constexpr double kMoved_px = 1.5, kMovedAcross_mm = 3, kMovedAlong_mm = 6;
/// @}
constexpr int kPlainlyMissing = 5;  ///< images; in one or two the board may have been blurred

/// Compares the place of the second camera with a board that is held still before both cameras.
/// Errors: bad_data (the cameras never saw the board together), those of
/// take_pair_views().
Result<Outcome> check_pair(Desk& desk) {
  const auto seen = take_pair_views(desk, PairWanted::one_place);
  if (!seen) return tl::make_unexpected(seen.error());
  if (seen->views.empty() && seen->missing >= kPlainlyMissing)
    return Outcome{"the second camera does not see the board where it should by the calibration",
                   false,
                   {"the second camera looks elsewhere, or is covered, dark or out of focus: look "
                    "at it, and measure the step `pair` again if it has moved"}};
  const auto& second = *desk.used.camera2;
  const auto off = calib::pair_off(seen->views, desk.used.camera, second);
  if (!off)
    return fail(Errc::bad_data,
                "the board was never still where both cameras see it; hold it nearer to the middle "
                "of both images");
  return judge_pair(*off, desk.options.board.square_mm);
}

const char* instruct(const Options& options) {
  return options.check ? "Hold the board still where both cameras see all of it."
                       : "Hold the board where both cameras see all of it, still for a moment at "
                         "each place: near and far, left and right, tilted to all sides.";
}

std::vector<std::string> scene(const Options& options, double /*camera_hz*/) {
  auto settings = board_scene(options, 1);
  settings.emplace_back("twin.prop.views=both");
  return settings;
}

}  // namespace

const StepEntry kPairStep{.step = Step::pair,
                          .made = &calib::Made::pair,
                          .scene = scene,
                          .instruct = instruct,
                          .measure = measure_pair,
                          .check = check_pair};

Outcome judge_pair(const calib::PairOff& off, double square_mm) {
  const double across_mm = 1e3 * glm::length(off.across_m), along_mm = 1e3 * std::abs(off.along_m);
  const bool is_on_lines = off.off_line_px <= kMoved_px,
             is_as_far = along_mm <= kMovedAlong_mm || std::abs(off.parallax_px) <= kMoved_px;
  Outcome outcome{
      fmt::format("at {:.2f} m what both cameras see is off by {:.1f} mm across and {:.1f} mm "
                  "along the first camera's rays, and by {:.1f} px from epipolar lines",
                  off.depth_m, across_mm, along_mm, off.off_line_px),
      is_on_lines && across_mm <= kMovedAcross_mm && is_as_far};
  if (outcome.is_good) return outcome;
  outcome.findings.push_back(
      "one of the two cameras has moved since they were calibrated: measure the step `pair` "
      "again; if it was the first camera, also `screen`");
  // Epipolar lines do not depend on the size of the board.
  if (is_on_lines)
    outcome.findings.push_back(fmt::format(
        "or the squares of this board are not {:g} mm; name the board of the calibration with "
        "--board",
        square_mm));
  return outcome;
}

}  // namespace handcast::calibrate
