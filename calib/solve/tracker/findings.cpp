// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calib/solve/tracker/first_pose.hpp"

namespace handcast::calib {

Cover cover_of(const Observations& o, const TrackerPose& pose, const std::vector<bool>& inliers) {
  constexpr int kSquare_px = 60, kLeast = 3;
  std::map<std::pair<int, int>, int> squares;
  std::vector<double> depths_m;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    const auto& s = o.sightings[i];
    const auto moving = o.track.at(s.point, s.time_s + pose.offset_s);
    if (!inliers[i] || !moving) continue;
    depths_m.push_back(pose.apply(moving->at_m).z);
    if (s.px.x >= 0 && s.px.x < o.camera.width_px && s.px.y >= 0 && s.px.y < o.camera.height_px)
      ++squares[{static_cast<int>(s.px.x) / kSquare_px, static_cast<int>(s.px.y) / kSquare_px}];
  }
  const auto full =
      std::ranges::count_if(squares, [](const auto& s) { return s.second >= kLeast; });
  const double area_px2 = static_cast<double>(o.camera.width_px) * o.camera.height_px;
  return {static_cast<double>(full) * kSquare_px * kSquare_px / area_px2,
          percentile_of(depths_m, 0.98) - percentile_of(depths_m, 0.02),
          1000 * percentile_of(depths_m, 0.5) / o.camera.fx_px};
}

std::optional<MisfitRun> misfit_run(const Observations& o, const std::vector<bool>& inliers) {
  constexpr double kBin_s = 0.1, kLeast_s = 0.5, kFewer = 0.25;
  const double begin_s = o.sightings.front().time_s;
  struct Bin {
    double seen = 0, fit = 0;
  };
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    const auto bin = static_cast<std::size_t>((o.sightings[i].time_s - begin_s) / kBin_s);
    if (bins.size() <= bin) bins.resize(bin + 1);
    ++bins[bin].seen;
    bins[bin].fit += inliers[i];
  }
  std::vector<double> shares;
  for (const auto& bin : bins)
    if (bin.seen > 0) shares.push_back(bin.fit / bin.seen);
  const double usual = percentile_of(shares, 0.5);

  // The run with the largest sum of what is missing to half of the usual share (Kadane).
  double sum = 0, best = 0;
  std::size_t from = 0, best_from = 0, best_to = 0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    sum += bins[b].seen > 0 ? usual / 2 - bins[b].fit / bins[b].seen : 0;
    if (sum <= 0) {
      sum = 0;
      from = b + 1;
    } else if (sum > best) {
      best = sum;
      best_from = from;
      best_to = b + 1;
    }
  }
  // What fits by chance at the start or the end goes with the run.
  if (4 * best_from < best_to - best_from) best_from = 0;
  if (4 * (bins.size() - best_to) < best_to - best_from) best_to = bins.size();
  const auto length = static_cast<double>(best_to - best_from);
  const bool few = best > (0.5 - kFewer) * usual * length;
  if (length * kBin_s < kLeast_s || !few) return std::nullopt;
  return MisfitRun{static_cast<double>(best_from) * kBin_s, static_cast<double>(best_to) * kBin_s};
}

std::optional<std::string> other_finger(const Observations& o, const Refined& refined) {
  constexpr std::size_t kLeastImages = 20;
  std::map<std::pair<int, int>, std::set<double>> fits;  // times by point and other point
  const auto distances = o.distances_px(refined.pose);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const auto& s = o.sightings[i];
    const double limit_px = kTukey * refined.scale * s.sigma;
    if (!(distances[i] >= limit_px)) continue;
    for (int other = 0; other < o.track.points(); ++other) {
      const auto moving = o.track.at(other, s.time_s + refined.pose.offset_s);
      const auto at = moving ? refined.pose.apply(moving->at_m) : glm::dvec3(0);
      if (at.z > 0 && glm::distance(o.camera.project(at), s.px) < limit_px)
        fits[{s.point, other}].insert(s.time_s);
    }
  }
  if (fits.empty()) return std::nullopt;
  const auto& [points, times_s] =
      *std::ranges::max_element(fits, {}, [](const auto& fit) { return fit.second.size(); });
  if (times_s.size() < kLeastImages) return std::nullopt;
  const std::vector<double> sorted(times_s.begin(), times_s.end());
  const double begin_s = o.sightings.front().time_s;
  const double from_s = percentile_of(sorted, 0.02), to_s = percentile_of(sorted, 0.98);
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const auto& s = o.sightings[i];
    outliers += s.point == points.first && s.time_s >= from_s && s.time_s <= to_s &&
                distances[i] >= kTukey * refined.scale * s.sigma;
  }
  if (2 * times_s.size() < outliers) return std::nullopt;
  return fmt::format(
      "Between {:.1f} and {:.1f} s, {} sightings of point {} fit point {}: another "
      "finger was seen.",
      from_s - begin_s, to_s - begin_s, times_s.size(), points.first, points.second);
}

std::optional<std::string> mirrored_fit(const Observations& o, double cost_px2) {
  constexpr double kMuchBetter = 0.7;
  const auto better = [&](const Observations& other) {
    const auto found = first_poses(other);
    return !found.empty() && found.front().cost_px2 < kMuchBetter * cost_px2;
  };
  auto image = o;
  for (auto& s : image.sightings) s.px.x = 2 * o.camera.cx_px - s.px.x;
  if (better(image))
    return "The mirrored image fits much better: the camera's image is mirrored, or the points "
           "of the hand are.";
  const auto mirrored = o.track.mirrored_hand();
  if (!mirrored) return std::nullopt;
  auto hand = o;
  hand.track = *mirrored;
  if (better(hand))
    return "The mirrored hand fits much better: the tracker takes the hand for the other one.";
  return std::nullopt;
}

namespace {

/// The limits in the documentation of Quality.
/// @{
struct Limits {
  double light_mm, inlier_share, held_out_px, held_out_mm, image_share, depth_m;

  /// Landmarks of a hand are never quite the tracker's joints.
  double held_out_px_of(const Evidence& evidence) const {
    return evidence.is_hand && evidence.cover.mm_per_px > 0
               ? std::max(held_out_px, held_out_mm / evidence.cover.mm_per_px)
               : held_out_px;
  }
};
constexpr Limits kGood{1, 0.6, 3, 4, 0.15, 0.10}, kPoor{3, 0.4, 6, 8, 0.08, 0.05};
constexpr double kGoodOffset_ms = 2, kPoorPlace_mm = 10;
/// @}
/// At the edge of the search for the clock offset.
constexpr double kEdge_ms = 1000 * kSearch_s - 5;
constexpr double kFlat_m = 0.005;

bool within(const Limits& limits, const Evidence& evidence, const TrackerFit& fit) {
  const auto& cover = evidence.cover;
  const double light_mm = std::ranges::max(fit.place_errors, {}, &PlaceError::light_mm).light_mm;
  return light_mm <= limits.light_mm && fit.inlier_share >= limits.inlier_share &&
         fit.held_out.median_px <= limits.held_out_px_of(evidence) &&
         cover.image_share >= limits.image_share && cover.depth_m >= limits.depth_m;
}

bool at_the_edge(const TrackerFit& fit) {
  return std::abs(static_cast<double>(fit.clock_offset_ns)) * 1e-6 >= kEdge_ms;
}

double largest_place_sd_mm(const TrackerFit& fit) {
  return std::ranges::max(fit.camera_place_mm, {}, &Interval::sd).sd;
}

Quality quality_of(const Evidence& evidence, const TrackerFit& fit) {
  if (!within(kPoor, evidence, fit) || largest_place_sd_mm(fit) > kPoorPlace_mm ||
      evidence.second_pose_rad || evidence.mirrored || at_the_edge(fit))
    return Quality::poor;
  return within(kGood, evidence, fit) && fit.clock_offset_ms.high <= kGoodOffset_ms
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
  if (fit.held_out.median_px > kGood.held_out_px_of(evidence))
    findings.push_back(
        fmt::format("Sightings that took no part in the fit are off by {:.1f} px, {:.1f} mm there "
                    "(median): camera and tracker do not see the same points, or "
                    "the lens is not calibrated well.",
                    fit.held_out.median_px, fit.held_out.median_px * evidence.cover.mm_per_px));
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
