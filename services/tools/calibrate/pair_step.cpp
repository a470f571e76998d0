// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pair_step.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "services/tools/calibrate/lens_memory.hpp"
#include "services/tools/calibrate/pair_views.hpp"
#include "services/tools/calibrate/pictures.hpp"

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

std::string picture_of(const calib::CameraModel& camera, std::span<const calib::PairView> views,
                       calib::BoardView calib::PairView::*image, std::string_view which) {
  std::vector<glm::dvec2> dots;
  for (const auto& view : views)
    dots.insert(dots.end(), (view.*image).image_px.begin(), (view.*image).image_px.end());
  return dots_svg(camera.width_px, camera.height_px, dots,
                  fmt::format("Where the {} camera saw the board: {} corners in {} images.", which,
                              dots.size(), views.size()));
}

std::string errors_of(const calib::PairFit& fit) {
  std::vector<Bar> errors;
  for (const auto& view : fit.views) errors.push_back({view.rms_px, !view.rejected.empty()});
  return bars_svg(
      errors, "px",
      "How far the corners of each view are from where the fit has them in both images, "
      "root mean square. Views without a bar were left out.");
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

}  // namespace

Result<Outcome> measure_pair(Desk& desk) {
  auto& second = desk.draft.camera2;
  if (!second) return fail(Errc::bad_config, "the rig has no second camera");
  const auto views = take_pair_views(desk);
  if (!views) return tl::make_unexpected(views.error());
  Outcome outcome;
  const calib::KnownLenses lenses{known_lens(desk, "lens", desk.draft.camera, outcome),
                                  known_lens(desk, "lens2", second->camera, outcome)};
  const auto fit = calib::fit_pair(*views, lenses);
  if (!fit) return tl::make_unexpected(fit.error());
  second->from_camera = fit->second_from_first;
  describe(*fit, outcome);
  outcome.pictures = picture_of(desk.draft.camera, *views, &calib::PairView::first, "first") +
                     picture_of(second->camera, *views, &calib::PairView::second, "second") +
                     errors_of(*fit);
  return outcome;
}

}  // namespace handcast::calibrate
