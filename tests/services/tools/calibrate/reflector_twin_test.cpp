// SPDX-License-Identifier: Apache-2.0
// The twin draws a reflector on a moving finger; where its tracker is, is known.
#include <gmock/gmock.h>

#include "calib/solve/tracker/fit_reflector.hpp"
#include "calib/solve/tracker/reflector.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::array<std::size_t, 5> kTips{5, 10, 15, 20, 25};
constexpr int kEvery = 17;  ///< images: 525 / 17 = 31 Hz

struct Recorded {
  std::array<calib::TrackedTips, 1> hands{calib::TrackedTips{"left", {}}};
  std::vector<calib::Sighting> sightings;
  int images = 0;
  int near = 0;  ///< spots within a pixel of the true tip
};

Recorded record(const twin::Twin& twin, const calib::CameraModel& camera, double seconds) {
  Recorded recorded;
  for (std::uint64_t k = 0; twin.tracker_time_ns(k) < seconds_to_ns(seconds + 0.2); ++k) {
    const auto sample = twin.tracker_sample(k).poses;
    const auto* hand = sample.find(msg::Side::left);
    if (!hand) continue;
    calib::TrackerSample tips{sample.header.origin_ns, {}};
    for (const auto tip : kTips) {
      const auto& [x, y, z] = hand->joints[tip].position_m;
      tips.points_m.emplace_back(x, y, z);
    }
    recorded.hands[0].samples.push_back(std::move(tips));
  }
  renderer::Image<std::uint8_t> image(camera.width_px, camera.height_px);
  for (std::uint64_t k = 0; twin.camera_origin_ns(k) < seconds_to_ns(seconds); k += kEvery) {
    twin.camera_image(k, image.view());
    const auto view = image.view();
    const auto found = calib::find_reflector({view.data, view.width, view.height, view.stride});
    ++recorded.images;
    if (found.fault != calib::ReflectorFault::none) continue;
    const auto px = camera.undistort(found.image_px);
    const auto truth = glm::dvec2((*twin.landmarks(msg::Side::left, twin.camera_origin_ns(k)))[8]);
    recorded.near += glm::distance(px, truth) < 1;
    recorded.sightings.push_back({twin.camera_stamp_ns(k), calib::kIndexTip, px, 0.3});
  }
  return recorded;
}

TEST(ReflectorOnTheTwin, FindsATrackerThatIs20mmAnd3DegreesAwayAndItsClock) {
  config::Rig rig;
  rig.twin.motion = "builtin:places";
  rig.twin.image.reflector_mm = 8;
  rig.twin.image.gain = 80;
  rig.twin.geometry.tracker_mm = 20;
  rig.twin.geometry.tracker_deg = 3;
  rig.twin.tracker.offset_mm = 0;
  rig.twin.tracker.rotation_deg = 0;
  rig.twin.tracker.scale = 1;
  rig.twin.tracker.drift_px = 1;
  rig.twin.tracker.clock_skew_ms = -5;
  const auto believed = calib::reference_rig();
  const auto twin = twin::Twin::create(rig, believed).value();
  const auto recorded = record(*twin, believed.camera, 40);
  EXPECT_GT(recorded.sightings.size(), 0.6 * recorded.images);
  // The others are half hidden by a bent finger.
  EXPECT_GT(recorded.near, 0.75 * static_cast<double>(recorded.sightings.size()));

  const auto fit = calib::fit_reflector(believed.camera, recorded.hands, recorded.sightings);
  ASSERT_TRUE(fit) << fit.error().what;
  const auto& truth = twin->geometry().calibration().camera_from_tracker;
  const auto place = fit->place_errors.front().place_m;
  const auto off = fit->camera_from_tracker * glm::inverse(truth) * glm::dvec4(place, 1);
  EXPECT_LT(1e3 * glm::distance(glm::dvec3(off), place), 2);
  EXPECT_GT(fit->inlier_share, 0.8);
  EXPECT_NE(fit->quality, calib::Quality::poor);
}

}  // namespace
}  // namespace handcast::calibrate
