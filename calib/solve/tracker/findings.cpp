// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace handcast::calib {
namespace {

/// The limits in the documentation of Quality.
/// @{
struct Limits {
  double light_mm, inlier_share, held_out_px, image_share, depth_m;
};
constexpr Limits kGood{1, 0.6, 3, 0.15, 0.10}, kPoor{3, 0.4, 6, 0.08, 0.05};
constexpr double kGoodOffset_ms = 2, kPoorPlace_mm = 10;
/// @}
/// At the edge of the search for the clock offset.
constexpr double kEdge_ms = 1000 * kSearch_s - 5;
constexpr double kFlat_m = 0.005;

bool within(const Limits& limits, const Cover& cover, const TrackerFit& fit) {
  const double light_mm = std::ranges::max(fit.place_errors, {}, &PlaceError::light_mm).light_mm;
  return light_mm <= limits.light_mm && fit.inlier_share >= limits.inlier_share &&
         fit.held_out.median_px <= limits.held_out_px && cover.image_share >= limits.image_share &&
         cover.depth_m >= limits.depth_m;
}

bool at_the_edge(const TrackerFit& fit) {
  return std::abs(static_cast<double>(fit.clock_offset_ns)) * 1e-6 >= kEdge_ms;
}

double largest_place_sd_mm(const TrackerFit& fit) {
  return std::ranges::max(fit.camera_place_mm, {}, &Interval::sd).sd;
}

Quality quality_of(const Evidence& evidence, const TrackerFit& fit) {
  if (!within(kPoor, evidence.cover, fit) || largest_place_sd_mm(fit) > kPoorPlace_mm ||
      evidence.second_pose_rad || evidence.mirrored || at_the_edge(fit))
    return Quality::poor;
  return within(kGood, evidence.cover, fit) && fit.clock_offset_ms.high <= kGoodOffset_ms
             ? Quality::good
             : Quality::usable;
}

void say_impossible(const Evidence& evidence, const TrackerFit& fit,
                    std::vector<std::string>& findings) {
  if (evidence.mirrored) findings.push_back(*evidence.mirrored);
  if (evidence.second_pose_rad)
    findings.push_back(
        fmt::format("A second pose, {:.0f} degrees away, fits nearly as well; move "
                    "the hand through more of the volume, nearer and farther.",
                    glm::degrees(*evidence.second_pose_rad)));
  if (at_the_edge(fit))
    findings.push_back(
        fmt::format("The offset of the clocks, {:.0f} ms, is at the edge of the "
                    "search; compare the clocks of camera and tracker.",
                    static_cast<double>(fit.clock_offset_ns) * 1e-6));
  if (evidence.other_finger) findings.push_back(*evidence.other_finger);
}

void say_spread(const Evidence& evidence, const TrackerFit& fit,
                std::vector<std::string>& findings) {
  const auto& cover = evidence.cover;
  const auto& place = fit.camera_place_mm;
  if (cover.image_share < kGood.image_share || cover.depth_m < kGood.depth_m)
    findings.push_back(fmt::format(
        "The points cover only {:.0f} % of the image and {:.0f} cm of depth: the distance of the "
        "camera along its axis is uncertain by {:.1f} mm; move the hand {}.",
        100 * cover.image_share, 100 * cover.depth_m, place[2].high,
        cover.depth_m < kGood.depth_m ? "nearer and farther" : "to the corners of the image"));
  if (largest_place_sd_mm(fit) > kPoorPlace_mm / 3)
    findings.push_back(
        fmt::format("The camera's place is known only to +-{:.0f} mm to the right, "
                    "+-{:.0f} mm down and +-{:.0f} mm forward (95 %).",
                    place[0].high, place[1].high, place[2].high));
  if (evidence.limit_shift_mm > kPoorPlace_mm / 3)
    findings.push_back(
        fmt::format("The camera's place moves by {:.0f} mm if outliers are judged "
                    "more or less strictly: the errors are not random.",
                    evidence.limit_shift_mm));
  if (evidence.plane_m < kFlat_m)
    findings.push_back(
        fmt::format("The points lie in a plane, to within {:.1f} mm; move the hand "
                    "in all directions.",
                    1000 * evidence.plane_m));
}

void say_misfits(const Evidence& evidence, const TrackerFit& fit,
                 std::vector<std::string>& findings) {
  for (const auto& run : evidence.runs)
    findings.push_back(
        run.begin_s == 0
            ? fmt::format("The first {:.1f} s do not fit: they were left out.", run.end_s)
            : fmt::format("The time from {:.1f} to {:.1f} s does not fit: it was left out.",
                          run.begin_s, run.end_s));
  if (fit.inlier_share < kGood.inlier_share)
    findings.push_back(fmt::format(
        "Only {:.0f} % of the sightings fit; likely reasons: {}.", 100 * fit.inlier_share,
        evidence.other_finger ? "another finger was seen"
        : evidence.runs.empty()
            ? "reflections or false detections in the image, or a tracker that loses the hand"
            : "the hand was out of the tracker's reach for a while"));
  if (fit.held_out.median_px > kGood.held_out_px)
    findings.push_back(
        fmt::format("Sightings that took no part in the fit are off by {:.1f} px "
                    "(median): camera and tracker do not see the same points, or "
                    "the lens is not calibrated well.",
                    fit.held_out.median_px));
  if (fit.clock_offset_ms.high > kGoodOffset_ms)
    findings.push_back(
        fmt::format("The offset of the clocks is known only to +-{:.1f} ms; move "
                    "the hand faster and change its direction more often.",
                    fit.clock_offset_ms.high));
}

void say_left_out(const Evidence& evidence, std::vector<std::string>& findings) {
  if (evidence.unusable_sightings > 0)
    findings.push_back(
        fmt::format("{} sightings had numbers that were not finite or not positive: "
                    "they were left out.",
                    evidence.unusable_sightings));
  if (evidence.unusable_samples > 0)
    findings.push_back(
        fmt::format("{} samples of the tracker had numbers that were not finite or a "
                    "repeated time: they were left out.",
                    evidence.unusable_samples));
}

}  // namespace

void judge(const Evidence& evidence, TrackerFit& fit) {
  fit.quality = quality_of(evidence, fit);
  say_impossible(evidence, fit, fit.findings);
  say_spread(evidence, fit, fit.findings);
  say_misfits(evidence, fit, fit.findings);
  say_left_out(evidence, fit.findings);
}

}  // namespace handcast::calib
