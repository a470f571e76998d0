// SPDX-License-Identifier: Apache-2.0
// Hands from two views on the twin's model of a detector, whose landmarks are those of a person
// with bones up to 4 % longer or shorter than the model's.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr std::int64_t kStep_ns = 8'000'000;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The mean errors of the left hand, mm, from sample `from` on. `later_ns`: of the second view.
std::vector<double> follow(TwoViews& world, int samples, std::int64_t later_ns = 0, int from = 0) {
  std::vector<double> errors;
  for (int i = 0; i < samples; ++i) {
    const auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns + later_ns);
    const auto poses = world.tracker().sample({&here, &there});
    EXPECT_EQ(poses.header.origin_ns, i * kStep_ns + later_ns);
    const auto* pose = poses.find(msg::Side::left);
    EXPECT_TRUE(pose) << "sample " << i;
    if (pose && i >= from) errors.push_back(world.error_mm(*pose, poses.header.origin_ns));
  }
  return errors;
}

TEST(Stereo, AHandIsWhereItIsWithinMillimetres) {
  for (const auto* motion : {"wave", "open_close", "pinch", "rotate"}) {
    TwoViews world(with_noise(2), motion);
    const auto errors = follow(world, 250);
    EXPECT_LT(mean_of(errors), 5) << motion;
  }
}

TEST(Stereo, AFistAndAHandThatPointsAtTheCameraAreFollowed) {
  for (const auto* motion : {"fist", "point_at_camera"}) {
    TwoViews world(with_noise(2), motion);
    EXPECT_LT(mean_of(follow(world, 250)), 7) << motion;
  }
}

TEST(Stereo, ImagesAtDifferentTimesAreMovedToOneTime) {
  TwoViews together(with_noise(1), "shake"), apart(with_noise(1), "shake");
  const double same = mean_of(follow(together, 250));
  EXPECT_LT(mean_of(follow(apart, 250, 4'000'000)), 1.5 * same);
}

TEST(Stereo, TheLengthsOfTheBonesAreLearnedAndKept) {
  auto rig = with_noise(5);
  rig.twin.shape.length_spread = 0.2;
  TwoViews world(rig, "wave");
  const auto truth = world.twin().joints(msg::Side::left, 0).value();
  const auto at = [](const msg::Joint& joint) {
    return glm::vec3(joint.position_m[0], joint.position_m[1], joint.position_m[2]);
  };
  const std::array bones{7, 8, 12, 13, 17, 18, 22, 23};  // the joints at which they begin
  /// Mean error of the lengths, and the length of one bone, mm.
  double first_off_mm = 0, last_off_mm = 0;
  std::vector<double> late_mm;
  for (int i = 0; i < 1000; ++i) {
    const auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 1u);
    const auto& joints = poses.hands[0].joints;
    double off_mm = 0;
    for (const int bone : bones)
      off_mm += 1e3 / bones.size() *
                std::abs(glm::distance(at(joints[bone]), at(joints[bone + 1])) -
                         glm::distance(glm::vec3(truth[bone][3]), glm::vec3(truth[bone + 1][3])));
    (i == 0 ? first_off_mm : last_off_mm) = off_mm;
    if (i >= 900) late_mm.push_back(1e3 * glm::distance(at(joints[12]), at(joints[13])));
  }
  EXPECT_LT(last_off_mm, 0.5 * first_off_mm);
  const auto [least, most] = std::ranges::minmax(late_mm);
  EXPECT_LT(most - least, 0.5) << "bones do not breathe";
}

TEST(Stereo, OneViewIsEnoughForAWhile) {
  TwoViews world(with_noise(1), "wave");
  follow(world, 250);
  for (int i = 250; i < 350; ++i) {
    const auto here = world.seen(i < 300 ? 0 : 1, i * kStep_ns);
    const auto poses = i < 300 ? world.tracker().sample({&here, nullptr})
                               : world.tracker().sample({nullptr, &here});
    ASSERT_EQ(poses.count, 1u) << i;
    EXPECT_LT(world.error_mm(poses.hands[0], poses.header.origin_ns), 15) << i;
  }
}

TEST(Stereo, AHandThatOneViewAloneSeesIsLessSure) {
  TwoViews world(with_noise(1), "wave");
  follow(world, 100);
  float before = 0;
  for (int i = 100; i < 230; ++i) {
    const auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    const auto poses = world.tracker().sample({&here, i < 110 ? &there : nullptr});
    ASSERT_EQ(poses.count, 1u) << i;
    if (i == 109) before = poses.hands[0].confidence;
    if (i == 229) {
      EXPECT_LT(poses.hands[0].confidence, 0.7f * before);
    }
  }
}

TEST(Stereo, AHandThatOnlyTheFirstViewHasEverSeenIsWhereItsSizePutsIt) {
  TwoViews world(with_noise(1), "still");
  const auto here = world.seen(0, 0);
  const auto poses = world.tracker().sample({&here, nullptr});
  ASSERT_EQ(poses.count, 1u);
  EXPECT_LT(world.error_mm(poses.hands[0], 0), 120) << "12 % of the distance";
  EXPECT_LE(poses.hands[0].confidence, 0.5f);
  const auto again = world.seen(0, kStep_ns), there = world.seen(1, kStep_ns);
  const auto both = world.tracker().sample({&again, &there});
  ASSERT_EQ(both.count, 1u);
  EXPECT_LT(world.error_mm(both.hands[0], kStep_ns), 8) << "the second view gives the depth";
}

TEST(Stereo, TwoHandsCrossWithoutChangingSides) {
  TwoViews world(with_noise(2), "crossing");
  std::vector<double> errors;
  for (int i = 0; i < 330; ++i) {
    const auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 2u) << i;
    for (const auto& pose : poses.hands)
      errors.push_back(world.error_mm(pose, poses.header.origin_ns));
  }
  EXPECT_LT(mean_of(errors), 5);
  EXPECT_LT(*std::ranges::max_element(errors), 40) << "a hand at the other's place is 100 mm off";
}

TEST(Stereo, ADetectorThatExchangesSidesForAMomentDoesNotExchangeHands) {
  TwoViews world(with_noise(1), "two_hands");
  for (int i = 0; i < 200; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    if (i > 100 && i < 130) std::swap(there.hands[0].side, there.hands[1].side);
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 2u) << i;
    for (const auto& pose : poses.hands)
      EXPECT_LT(world.error_mm(pose, poses.header.origin_ns), 30) << i;
  }
}

TEST(Stereo, AHandThatBothDetectorsTakeForTheOtherForAMomentKeepsItsSide) {
  TwoViews world(with_noise(1), "wave");
  for (int i = 0; i < 150; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    if (i > 100 && i < 130) here.hands[0].side = there.hands[0].side = msg::Side::right;
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 1u) << i;
    EXPECT_EQ(poses.hands[0].side, msg::Side::left) << i;
  }
}

TEST(Stereo, AHandThatBeganAsTheWrongOneIsCorrected) {
  TwoViews world(with_noise(1), "wave");
  msg::HandPoses poses;
  for (int i = 0; i < 700; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    if (i < 20) here.hands[0].side = there.hands[0].side = msg::Side::right;
    poses = world.tracker().sample({&here, &there});
  }
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.hands[0].side, msg::Side::left);
}

TEST(Stereo, AHandThatBothDetectorsTakeForTheOtherIsKnownByItsShape) {
  for (const auto* motion : {"wave", "open_close", "rotate"}) {
    TwoViews world(with_noise(1), motion);
    int exchanged = 0;
    for (int i = 0; i < 250; ++i) {
      auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
      here.hands[0].side = there.hands[0].side = msg::Side::right;
      const auto poses = world.tracker().sample({&here, &there});
      ASSERT_EQ(poses.count, 1u) << motion << i;
      exchanged += poses.hands[0].side == msg::Side::right;
      if (i >= 100) {
        EXPECT_EQ(poses.hands[0].side, msg::Side::left) << motion << i;
      }
    }
    EXPECT_LT(exchanged, 60) << motion;
  }
}

TEST(Stereo, WhichHandOneViewAloneSeesItsDetectorSays) {
  auto rig = with_noise(1);
  rig.pose.stereo.one_view_s = 0.1;
  TwoViews world(rig, "wave");
  msg::HandPoses poses;
  for (int i = 0; i < 600; ++i) {
    auto here = world.seen(0, i * kStep_ns);
    if (i < 20) here.hands[0].side = msg::Side::right;
    poses = world.tracker().sample({&here, nullptr});
  }
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.hands[0].side, msg::Side::left);
}

TEST(Stereo, TwoHandsThatBothDetectorsExchangeAreKnownByTheirShapes) {
  TwoViews world(with_noise(1), "two_hands");
  for (int i = 0; i < 200; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    for (auto* seen : {&here, &there}) std::swap(seen->hands[0].side, seen->hands[1].side);
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 2u) << i;
    for (const auto& pose : poses.hands)
      if (i >= 100) {
        EXPECT_LT(world.error_mm(pose, poses.header.origin_ns), 30) << i;
      }
  }
}

TEST(Stereo, AHandThatReturnsElsewhereIsFoundAtOnce) {
  TwoViews world(with_noise(1), "wave");
  follow(world, 100);
  const std::int64_t later_ns = 3'000'000'000;
  const auto here = world.seen(0, later_ns), there = world.seen(1, later_ns);
  const auto poses = world.tracker().sample({&here, &there});
  ASSERT_EQ(poses.count, 1u);
  EXPECT_LT(world.error_mm(poses.hands[0], later_ns), 8);
}

TEST(Stereo, LandmarksThatWereNotSeenPullAtNothing) {
  TwoViews world(with_noise(1), "wave");
  std::vector<double> errors;
  for (int i = 0; i < 100; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    for (auto* seen : {&here, &there})
      for (const int k : {6, 7, 8}) {
        seen->hands[0].points[k].x_px += 40;
        seen->hands[0].points[k].confidence = 0;
      }
    const auto poses = world.tracker().sample({&here, &there});
    ASSERT_EQ(poses.count, 1u);
    for (const int joint : {8, 9, 10})  // of the index finger
      errors.push_back(world.error_mm(poses.hands[0], joint, poses.header.origin_ns));
  }
  EXPECT_LT(mean_of(errors), 10) << "the finger is where hands have it";
}

TEST(Stereo, BadMessagesGiveNoPoseAndLeaveNothingBehind) {
  TwoViews world(with_noise(1), "wave");
  const auto good = world.seen(0, 1), other = world.seen(1, 1);
  auto infinite = good;
  infinite.hands[0].points[3].x_px = std::numeric_limits<float>::infinity();
  EXPECT_EQ(world.tracker().sample({&infinite, nullptr}).count, 0u);
  auto few = good;
  for (std::size_t i = 7; i < 21; ++i) few.hands[0].points[i].confidence = 0;
  EXPECT_EQ(world.tracker().sample({&few, nullptr}).count, 0u);
  auto together = good;
  for (auto& point : together.hands[0].points) point = {100, 100, 1, 0};
  EXPECT_EQ(world.tracker().sample({&together, &together}).count, 0u);
  auto no_side = good;
  no_side.hands[0].side = static_cast<msg::Side>(77);
  no_side.count = 9;
  EXPECT_LE(world.tracker().sample({&no_side, nullptr}).count, 2u);
  EXPECT_EQ(world.tracker().sample({nullptr, nullptr}).count, 0u);
  EXPECT_EQ(world.tracker().sample({&good, &other}).count, 1u);
}

TEST(Stereo, NonsenseGivesNoPoseThatIsNotFinite) {
  TwoViews world(with_noise(1), "wave");
  for (int i = 0; i < 200; ++i) {
    auto here = world.seen(0, i * kStep_ns), there = world.seen(1, i * kStep_ns);
    for (auto* seen : {&here, &there})
      for (std::size_t k = 0; k < 21; ++k) {
        seen->hands[0].points[k].x_px += static_cast<float>(((i * 37 + k * 101) % 997)) - 498;
        seen->hands[0].points[k].y_px += static_cast<float>(((i * 53 + k * 71) % 991)) - 495;
      }
    const auto poses = world.tracker().sample({&here, &there});
    for (std::uint32_t h = 0; h < poses.count; ++h)
      for (const auto& joint : poses.hands[h].joints)
        for (const float value : joint.position_m) ASSERT_TRUE(std::isfinite(value));
  }
  const std::int64_t later_ns = 3'000'000'000;
  const auto here = world.seen(0, later_ns), there = world.seen(1, later_ns);
  EXPECT_EQ(world.tracker().sample({&here, &there}).count, 1u) << "a hand is followed again";
}

}  // namespace
}  // namespace handcast::pose::stereo
