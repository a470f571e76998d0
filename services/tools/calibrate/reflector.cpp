// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/reflector.hpp"

#include <array>

#include "calib/solve/tracker/fit_reflector.hpp"
#include "calib/solve/tracker/volume_coverage.hpp"
#include "services/tools/calibrate/tracker_step.hpp"

namespace handcast::calibrate {
namespace {

/// Of the thumb to the little finger.
constexpr std::array<std::size_t, 5> kTips{5, 10, 15, 20, 25};
/// Of the centre of a spot that is some pixels across.
constexpr double kSigma_px = 0.3;

/// What tracker and camera have seen.
struct Seen {
  std::array<calib::TrackedTips, msg::kMaxHands> hands{calib::TrackedTips{"left", {}},
                                                       calib::TrackedTips{"right", {}}};
  std::vector<calib::Sighting> sightings;
  calib::ReflectorFault last_fault = calib::ReflectorFault::dark;
};

void add_samples(client::Stream<msg::HandPoses>& poses, Seen& seen) {
  while (const auto sample = poses.next(Deadline::now()))
    for (const auto& hand : hands_of(**sample)) {
      calib::TrackerSample tips{(*sample)->header.origin_ns, {}};
      for (const auto tip : kTips) {
        const auto& [x, y, z] = hand.joints[tip].position_m;
        tips.points_m.emplace_back(x, y, z);
      }
      seen.hands[static_cast<std::size_t>(hand.side)].samples.push_back(std::move(tips));
    }
}

/// Adds the reflector of an image. `spot_mm`: how large it is.
void add_sighting(const calib::CameraModel& camera, const msg::CameraFrame& frame, double spot_mm,
                  calib::VolumeCoverage& coverage, Seen& seen) {
  const auto found = calib::find_reflector(view_of(frame));
  seen.last_fault = found.fault;
  if (found.fault != calib::ReflectorFault::none) return;
  const auto px = camera.undistort(found.image_px);
  seen.sightings.push_back({frame.header.origin_ns, calib::kIndexTip, px, kSigma_px});
  coverage.add(px, camera.fx_px * spot_mm * 1e-3 / found.diameter_px);
}

Result<Seen> watch(Desk& desk) {
  auto poses = client::open_stream<msg::HandPoses>(desk.rig.name, "pose.hands");
  if (!poses) return tl::make_unexpected(poses.error());
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  const auto& camera = desk.draft.camera;
  calib::VolumeCoverage coverage(camera, kNear_m, kFar_m);
  Harvest harvest;
  Seen seen;
  bool sees = false;
  Progress progress(desk, "tracker");
  while (harvest.goes_on(coverage.share(), sees) && progress.goes_on()) {
    progress.show(coverage.share(), sees ? harvest.advice(coverage.advice())
                                         : std::string(calib::advice_on(seen.last_fault)));
    const auto frame = progress.latest(*frames);
    if (frame) add_sighting(camera, **frame, desk.options.reflector_mm, coverage, seen);
    sees = frame && seen.last_fault == calib::ReflectorFault::none;
    add_samples(*poses, seen);
  }
  return progress.result().map([&] { return std::move(seen); });
}

}  // namespace

Result<calib::TrackerFit> fit_by_reflector(Desk& desk) {
  const auto seen = watch(desk);
  if (!seen) return tl::make_unexpected(seen.error());
  if (seen->sightings.empty())
    return fail(Errc::bad_data, std::string(calib::advice_on(seen->last_fault)));
  return calib::fit_reflector(desk.draft.camera, seen->hands, seen->sightings);
}

}  // namespace handcast::calibrate
