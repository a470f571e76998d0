// SPDX-License-Identifier: Apache-2.0
// Where the tracker is.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "calib/solve/tracker/volume_coverage.hpp"
#include "ipc/base/number_text.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/tools/calibrate/harvest.hpp"
#include "services/tools/calibrate/pictures.hpp"
#include "services/tools/calibrate/reflector_fit.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr double kSigmaIfUnknown_px = 3;
constexpr float kLeastConfidence = 0.3f;

/// What tracker and camera have seen of one hand.
struct Seen {
  std::vector<calib::TrackerSample> samples;
  std::vector<calib::Sighting> sightings;
};
using SeenBySide = std::array<Seen, msg::kMaxHands>;

glm::dvec3 place_of(const msg::Joint& joint) {
  return {joint.position_m[0], joint.position_m[1], joint.position_m[2]};
}

calib::TrackerSample sample_of(std::int64_t time_ns, const msg::HandPose& hand) {
  calib::TrackerSample sample{time_ns, {}};
  for (const int joint : msg::kJointOfLandmark)
    sample.points_m.push_back(place_of(hand.joints[static_cast<std::size_t>(joint)]));
  return sample;
}

/// The landmarks were undistorted with the lens in use; here they are with the draft's.
void add_sightings(const Desk& desk, std::int64_t time_ns, const msg::HandLandmarks& hand,
                   Seen& seen) {
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = hand.points[static_cast<std::size_t>(i)];
    if (point.confidence < kLeastConfidence) continue;
    const auto image_px = desk.used.camera.distort({point.x_px, point.y_px});
    seen.sightings.push_back({time_ns, i, desk.draft.camera.undistort(image_px),
                              point.sigma_px > 0 ? point.sigma_px : kSigmaIfUnknown_px});
  }
}

/// Adds the newest sample with the newest image: the advice may be some ms old.
void cover(const Seen& seen, calib::VolumeCoverage& coverage) {
  std::vector<calib::SeenPoint> hand;
  for (std::size_t i = seen.sightings.size(); i-- > 0;) {
    const auto& sighting = seen.sightings[i];
    if (sighting.time_ns != seen.sightings.back().time_ns) break;
    hand.push_back({sighting.undistorted_px,
                    seen.samples.back().points_m[static_cast<std::size_t>(sighting.point)]});
  }
  coverage.add(hand);
}

/// When camera and tracker have last seen a hand.
struct Noticed {
  std::int64_t landmarks_ns = now_ns(), pose_ns = now_ns();

  /// Says which of them sees no hand; else `otherwise`.
  std::string advice(const std::string& otherwise) const {
    constexpr std::int64_t kMissing_ns = 2'000'000'000;
    const bool camera = now_ns() - landmarks_ns < kMissing_ns,
               tracker = now_ns() - pose_ns < kMissing_ns;
    if (camera && tracker) return otherwise;
    if (camera) return "The tracker sees no hand: move it into the tracker's view, too";
    if (tracker) return "The camera sees no hand: move it to the middle of the camera's image";
    return "Neither camera nor tracker sees a hand: hold it in the middle of the image";
  }
};

/// Watches a hand until it was everywhere that it can reach, Enter is pressed, or the time is over.
Result<SeenBySide> watch(Desk& desk) {
  auto poses = client::open_stream<msg::HandPoses>(desk.rig.name, "pose.hands");
  if (!poses) return tl::make_unexpected(poses.error());
  auto landmarks = client::open_stream<msg::Landmarks>(desk.rig.name, "landmarks.hands");
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  calib::VolumeCoverage coverage(desk.draft.camera, kNear_m, kFar_m);
  Harvest harvest;
  Noticed noticed;
  bool sees_hand = false;
  SeenBySide seen;
  Progress progress(desk, "tracker");
  while (harvest.goes_on(coverage.share(), sees_hand)) {
    if (const auto on = progress.goes_on(); !on || !*on) {
      if (!on) return tl::make_unexpected(on.error());
      break;
    }
    progress.show(coverage.share(), noticed.advice(harvest.advice(coverage.advice())));
    const auto found = landmarks->next(Deadline::in(200ms));
    if (!found && found.error().code != Errc::timeout) return tl::make_unexpected(found.error());
    sees_hand = found && (*found)->count > 0;
    if (sees_hand) noticed.landmarks_ns = now_ns();
    if (found)
      for (std::uint32_t h = 0; h < std::min((*found)->count, std::uint32_t{msg::kMaxHands}); ++h) {
        const auto& hand = (*found)->hands[h];
        if (hand.side > msg::Side::right) continue;  // damaged
        add_sightings(desk, (*found)->header.origin_ns, hand,
                      seen[static_cast<std::size_t>(hand.side)]);
      }
    while (const auto sample = poses->next(Deadline::now()))
      for (std::uint32_t h = 0; h < std::min((*sample)->count, std::uint32_t{msg::kMaxHands});
           ++h) {
        const auto& hand = (*sample)->hands[h];
        if (hand.side > msg::Side::right) continue;  // damaged
        auto& of_side = seen[static_cast<std::size_t>(hand.side)];
        noticed.pose_ns = now_ns();
        of_side.samples.push_back(sample_of((*sample)->header.origin_ns, hand));
        cover(of_side, coverage);
      }
  }
  return seen;
}

/// The hand that was seen more often.
const Seen& most_seen(const SeenBySide& seen) {
  return seen[0].sightings.size() >= seen[1].sightings.size() ? seen[0] : seen[1];
}

/// `seen_px` gets where the hand was seen.
Result<calib::TrackerFit> fit(Desk& desk, std::vector<glm::dvec2>& seen_px) {
  if (desk.options.reflector_mm > 0) return fit_by_reflector(desk);
  const auto seen = watch(desk);
  if (!seen) return tl::make_unexpected(seen.error());
  const auto& hand = most_seen(*seen);
  if (hand.samples.empty())
    return fail(Errc::bad_data,
                "the tracker has seen no hand; `handcast status` shows whether it "
                "runs, and the hand must be in its view too");
  for (const auto& sighting : hand.sightings) seen_px.push_back(sighting.undistorted_px);
  return calib::fit_tracker(desk.draft.camera, hand.samples, hand.sightings);
}

/// How well light is placed in the middle and at the corners of the volume.
std::string errors_table(const calib::TrackerFit& fit) {
  std::string rows;
  for (const auto& error : fit.place_errors)
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.1f}</td><td>{:.1f}</td></tr>",
        &error == &fit.place_errors.front() ? "middle" : "corner",
        number_text(1e3 * error.place_m.x, 0), number_text(1e3 * error.place_m.y, 0),
        error.place_m.z, 2 * error.light_mm, 2 * error.whole_mm);
  return "<figure class='broad'><div class='wide'><table><thead><tr><th>place</th><th>right mm</th>"
         "<th>down mm</th><th>far m</th><th>light ± mm</th><th>space ± mm</th></tr></thead>"
         "<tbody>" +
         rows +
         "</tbody></table></div><figcaption>What the fit does not know, two standard deviations: "
         "how far light lands beside its target, and how far off the place is in space. Places are "
         "those of the camera's axes.</figcaption></figure>";
}

std::string made_of(const calib::TrackerFit& fit) {
  return fmt::format(
      "{:.1f} px held out, {:.0f} % of the points fit, light repeatable within {:.1f} mm, clock "
      "{} ms",
      fit.held_out.median_px, 100 * fit.inlier_share, 2 * fit.place_errors.front().light_mm,
      signed_text(ns_to_ms(fit.clock_offset_ns), 1));
}

/// By a hand that moves through the working volume: its joints by the tracker, its landmarks (or a
/// reflector) in the camera's images. Sets draft.camera_from_tracker. Errors: bad_data (there was
/// no hand, or the two do not fit), and those of the streams.
Result<Outcome> measure_tracker(Desk& desk) {
  std::vector<glm::dvec2> seen_px;
  const auto found = fit(desk, seen_px);
  if (!found) return tl::make_unexpected(found.error());
  desk.draft.camera_from_tracker = found->camera_from_tracker;
  Outcome outcome{made_of(*found), found->quality != calib::Quality::poor, found->findings};
  outcome.meaning =
      "Held out: how far landmarks are from the tracker's joints in a part of the time that the "
      "fit has not seen, median; good is at most 3 px, or 4 mm on a hand. Repeatable: how far "
      "light lands beside its "
      "target because of what the fit does not know, two standard deviations; good is at most "
      "2 mm. Clock: how much the tracker's is ahead of the camera's";
  const auto& camera = desk.draft.camera;
  if (!seen_px.empty())
    outcome.pictures = dots_svg(camera.width_px, camera.height_px, seen_px,
                                "Where the hand was seen, near and far.");
  outcome.pictures += errors_table(*found);
  return outcome;
}

/// The tracker has moved if it is off by more than this and by more than twice what the fit does
/// not know.
/// @{
constexpr double kMovedAcross_mm = 2.5, kMovedAlong_mm = 6;
/// @}

/// Compares the calibration in use with what measure_tracker() finds.
Result<Outcome> check_tracker(Desk& desk) {
  std::vector<glm::dvec2> seen_px;
  const auto found = fit(desk, seen_px);
  if (!found) return tl::make_unexpected(found.error());
  const auto& middle = found->place_errors.front();
  const glm::dvec4 place = glm::inverse(found->camera_from_tracker) * glm::dvec4(middle.place_m, 1);
  const auto off_m =
      glm::dvec3(desk.used.camera_from_tracker * place - found->camera_from_tracker * place);
  const double across_mm = 1e3 * std::hypot(off_m.x, off_m.y), along_mm = 1e3 * std::abs(off_m.z);
  const double unsure_along_mm =
      std::sqrt(std::max(0.0, std::pow(middle.whole_mm, 2) - std::pow(middle.light_mm, 2)));
  Outcome outcome{
      fmt::format("in the middle of the volume the tracker's place is off by {:.1f} mm across (+- "
                  "{:.1f}) and {:.1f} mm along the camera's axis (+- {:.1f})",
                  across_mm, 2 * middle.light_mm, along_mm, 2 * unsure_along_mm),
      across_mm <= std::max(kMovedAcross_mm, 2 * middle.light_mm) &&
          along_mm <= std::max(kMovedAlong_mm, 2 * unsure_along_mm),
      found->findings};
  if (!outcome.is_good)
    outcome.findings.insert(outcome.findings.begin(),
                            "camera or tracker have moved since they were calibrated: measure the "
                            "step `tracker` again");
  return outcome;
}

std::vector<std::string> scene(const Options& options, double /*camera_hz*/) {
  if (options.reflector_mm == 0) return {"twin.motion=builtin:show"};
  return {fmt::format("twin.image.reflector_mm={}", options.reflector_mm),
          "twin.motion=builtin:places", "twin.image.gain=80"};
}

const char* instruct(const Options& options) {
  if (options.reflector_mm > 0)
    return "Take the board away, and put the reflector on the very tip of an index finger. Expose "
           "so briefly that only the reflector is white. Move the stretched finger through the "
           "whole volume in which the show takes place, nearer and farther, too, and turn the "
           "hand.";
  return options.check ? "Move an open hand through the middle of the volume, nearer and farther."
                       : "Take the board away. Move an open hand slowly through the whole volume "
                         "in which the show takes place, nearer and farther, too.";
}

}  // namespace

const StepEntry kTrackerStep{.step = Step::tracker,
                             .made = &calib::Made::tracker,
                             .scene = scene,
                             .instruct = instruct,
                             .measure = measure_tracker,
                             .check = check_tracker};

}  // namespace handcast::calibrate
