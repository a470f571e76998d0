// SPDX-License-Identifier: Apache-2.0
// Errors of sensors that change while they are open.
#include <algorithm>
#include <cstring>

#include "config/settings/settings.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

/// What the sensors of a twin say within its first second.
struct Said {
  std::vector<msg::HandPoses> poses;
  std::vector<Twin::Detection> detections;
  std::vector<std::int64_t> times_ns;
  renderer::Image<std::uint8_t> image{720, 540};

  bool operator==(const Said& other) const {
    const auto is_same = [](const auto& a, const auto& b) {
      return std::memcmp(&a, &b, sizeof a) == 0;
    };
    return std::ranges::equal(poses, other.poses, is_same) && times_ns == other.times_ns &&
           std::ranges::equal(detections, other.detections,
                              [&](const auto& a, const auto& b) {
                                return a.age_ns == b.age_ns && is_same(a.landmarks, b.landmarks);
                              }) &&
           std::ranges::equal(image.pixels(), other.image.pixels());
  }
};

Said listen(const Twin& twin) {
  Said said;
  for (std::uint64_t k = 0; k < 40; ++k) {
    said.poses.push_back(twin.tracker_sample(k).poses);
    said.detections.push_back(twin.detect(k, k, twin.camera_stamp_ns(k)));
    for (const auto time_ns : {twin.tracker_sample(k).arrival_ns, twin.camera_arrival_ns(k),
                               twin.camera_stamp_ns(k), std::int64_t{twin.camera_lost(k)}})
      said.times_ns.push_back(time_ns);
  }
  twin.camera_image(3, said.image.view());
  return said;
}

/// Other values of all live settings of [twin].
config::Rig with_other_errors(const config::Rig& rig) {
  auto other = rig;
  for (const auto& section : config::list_settings(other))
    for (const auto& setting : section.settings) {
      if (!setting.path.starts_with("twin.") || setting.effect != config::Effect::live) continue;
      if (auto* const* flag = std::get_if<bool*>(&setting.target)) **flag = !**flag;
      if (auto* const* number = std::get_if<double*>(&setting.target))
        **number = std::clamp(**number * 0.7 + 0.3, setting.range.min, setting.range.max);
      if (auto* const* number = std::get_if<int*>(&setting.target)) ++**number;
    }
  return other;
}

TEST(TwinAdjust, ATwinThatIsAdjustedIsAsOneThatWasMadeSo) {
  const auto rig = rig_with("builtin:open_close");
  const auto other = with_other_errors(rig);
  ASSERT_NE(other.twin.tracker.noise_mm, rig.twin.tracker.noise_mm);
  ASSERT_EQ(other.twin.tracker.rate_hz, rig.twin.tracker.rate_hz) << "it is not live";
  const auto twin = twin_of(rig);
  const auto before = listen(*twin);
  twin->adjust(other.twin);
  EXPECT_TRUE(listen(*twin) == listen(*twin_of(other)));
  EXPECT_FALSE(listen(*twin) == before);
  twin->adjust(rig.twin);
  EXPECT_TRUE(listen(*twin) == before);
}

TEST(TwinAdjust, ABoardStaysInTheHandWhileTheImageBecomesAnother) {
  auto rig = rig_with("builtin:still");
  rig.twin.prop.kind = config::TwinPropKind::board;
  const auto twin = twin_of(rig);
  const FlatPicture white{.width_px = 20,
                          .height_px = 20,
                          .pixels = std::vector<std::uint8_t>(400, 255),
                          .metres_per_px = 0.01,
                          .origin_px = {9.5, 9.5}};
  const auto shown = twin->show_board(white);
  ASSERT_TRUE(shown) << shown.error().what;
  const auto sum = [&] {
    renderer::Image<std::uint8_t> image(720, 540);
    twin->camera_image(0, image.view());
    double all = 0;
    for (const auto grey : image.pixels()) all += grey;
    return all;
  };
  const auto before = sum();
  rig.twin.image.dark = 0.5;
  twin->adjust(rig.twin);
  EXPECT_NEAR(sum() / before, 0.5, 0.02);
}

}  // namespace
}  // namespace handcast::twin
