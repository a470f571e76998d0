// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ipc/base/clock.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

/// The twin of a rig in which one of the two hands is left out.
class OnlyOneHand : public testing::TestWithParam<Side> {
 protected:
  static config::Rig rig(config::TwinHands hands) {
    auto rig = rig_with("builtin:two_hands");
    rig.twin.hands = hands;
    return rig;
  }
  const Side there = GetParam(), away = there == Side::left ? Side::right : Side::left;
  const std::unique_ptr<Twin> both = twin_of(rig(config::TwinHands::both)),
                              one = twin_of(rig(there == Side::left ? config::TwinHands::left
                                                                    : config::TwinHands::right));
};
INSTANTIATE_TEST_SUITE_P(Sides, OnlyOneHand, testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "Left" : "Right";
                         });

TEST_P(OnlyOneHand, TheTruthHasNoOther) {
  for (const double t_s : {0.0, 0.7, 4.0}) {
    const std::int64_t time_ns = seconds_to_ns(t_s);
    EXPECT_FALSE(one->joints(away, time_ns));
    EXPECT_FALSE(one->landmarks(away, time_ns));
    EXPECT_EQ(one->joints(there, time_ns), both->joints(there, time_ns))
        << "the remaining hand must move as before";
    EXPECT_EQ(one->landmarks(there, time_ns), both->landmarks(there, time_ns));
    EXPECT_TRUE(both->joints(away, time_ns));
  }
}

TEST_P(OnlyOneHand, TheTrackerReportsNoOther) {
  int seen = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const auto sample = one->tracker_sample(k), sample_of_both = both->tracker_sample(k);
    EXPECT_FALSE(sample.poses.find(away));
    const msg::HandPose *pose = sample.poses.find(there),
                        *pose_beside_other = sample_of_both.poses.find(there);
    ASSERT_EQ(pose != nullptr, pose_beside_other != nullptr);
    if (!pose) continue;
    EXPECT_EQ(sample.poses.count, 1u);
    EXPECT_EQ(pose->joints[10].position_m, pose_beside_other->joints[10].position_m);
    ++seen;
  }
  EXPECT_GT(seen, 50);
}

TEST_P(OnlyOneHand, TheDetectorSeesNoOther) {
  int seen = 0;
  for (std::uint64_t n = 0; n < 60; ++n) {
    const auto landmarks = one->detect(n, 8 * n, one->camera_origin_ns(8 * n)).landmarks;
    EXPECT_FALSE(landmarks.find(away));
    seen += landmarks.find(there) != nullptr && landmarks.count == 1;
  }
  EXPECT_GT(seen, 50);
}

TEST_P(OnlyOneHand, TheCameraShowsNoOther) {
  renderer::Image<std::uint8_t> image(720, 540), image_of_both(720, 540);
  one->camera_image(100, image.view());
  both->camera_image(100, image_of_both.view());
  constexpr int kBright = 60;
  const auto bright_in_half = [&](const renderer::Image<std::uint8_t>& shown, Side side) {
    int bright = 0;
    for (int y = 0; y < 540; ++y)
      for (int x = side == Side::left ? 0 : 360; x < (side == Side::left ? 360 : 720); ++x)
        bright += shown.at(x, y) > kBright;
    return bright;
  };
  EXPECT_GT(bright_in_half(image, there), 5000);
  EXPECT_GT(bright_in_half(image_of_both, away), 5000);
  EXPECT_LT(bright_in_half(image, away), 50);
}

}  // namespace
}  // namespace handcast::twin
