// SPDX-License-Identifier: Apache-2.0
// The back end `leapc` on a stand-in for Ultraleap's library.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>

#include "services/recording/arrays/npy.hpp"
#include "tests/services/pose/leapc/leapc_rig.hpp"
#include "tests/services/pose/pose_contract.hpp"

namespace handcast::pose {
namespace {

using test::FakeHand;

constexpr int kIndexTip = 10, kPalm = 0, kWrist = 1, kMiddleMetacarpal = 11;

glm::vec3 place_mm(const msg::Joint& joint) {
  return {joint.position_m[0] * 1e3f, joint.position_m[1] * 1e3f, joint.position_m[2] * 1e3f};
}

PoseBackend row_of_leapc() {
  prepare_rig = [](config::Rig& rig) {
    fresh_leap();
    rig.pose.leapc.library = FAKE_LEAPC;
  };
  return *std::ranges::find(pose_backends(), "leapc", &PoseBackend::name);
}
INSTANTIATE_TEST_SUITE_P(Leapc, PoseContract, testing::Values(row_of_leapc()), name_of_row);

void hold_still(std::int64_t, int which, FakeHand& hand) {
  if (which > 0) return;
  hand.joints[17] = {11, 222, -33};  // tip of the index finger
  hand.joints[1] = {1, 2, 3};
  hand.joints[18] = hand.joints[19] = {0, 210, -20};
  hand.joints[20] = {0, 210, -80};  // metacarpal of the middle finger
  hand.widths[9] = 14;
  const float half = std::sqrt(0.5f);
  hand.rotations[0] = {0, 0, half, half};  // the palm turned by a quarter about z
}

TEST(Leapc, TheJointsOfTheRigAreThoseOfTheBones) {
  auto& leap = fresh_leap();
  leap.motion = hold_still;
  const auto source = open_leapc_source();
  const auto poses = next_sample(*source);
  ASSERT_EQ(poses.count, 1u);
  const auto& joints = poses.hands[0].joints;
  const auto is_near = [](glm::vec3 a, glm::vec3 b) { return glm::distance(a, b) < 1e-3f; };
  EXPECT_TRUE(is_near(place_mm(joints[kIndexTip]), {11, 222, -33}));
  EXPECT_TRUE(is_near(place_mm(joints[kWrist]), {1, 2, 3}));
  EXPECT_NEAR(joints[kIndexTip].radius_m, 0.007f, 1e-6);
  EXPECT_EQ(poses.hands[0].confidence, 1);
  const auto& q = joints[kWrist].orientation_xyzw;
  EXPECT_NEAR(std::abs(q[2]), std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(std::abs(q[3]), std::sqrt(0.5), 1e-5);
  EXPECT_TRUE(is_near(place_mm(joints[kPalm]), 0.5f * (place_mm(joints[kMiddleMetacarpal]) +
                                                       place_mm(joints[kMiddleMetacarpal + 1]))));
}

TEST(Leapc, BothHandsAreReportedAndTheHandOfAThirdPersonIsLeftOut) {
  auto& leap = fresh_leap();
  leap.hands = 2;
  const auto source = open_leapc_source();
  auto poses = next_sample(*source);
  ASSERT_EQ(poses.count, 2u);
  EXPECT_TRUE(poses.find(msg::Side::left) && poses.find(msg::Side::right));
  leap.motion = [](std::int64_t, int which, FakeHand& hand) {
    hand.visible_us = which == 0 ? 10 : 1000;  // a left one, which has just come
  };
  leap.hands = 3;
  for (int i = 0; i < 5; ++i) poses = next_sample(*source);
  ASSERT_EQ(poses.count, 2u);
  EXPECT_LT(place_mm(poses.find(msg::Side::left)->joints[kWrist]).x, -200)
      << "the other left one, at -240";
}

TEST(Leapc, NoHandIsASampleWithoutOne) {
  fresh_leap().hands = 0;
  const auto source = open_leapc_source();
  EXPECT_EQ(next_sample(*source).count, 0u);
}

TEST(Leapc, OriginsAreTheTimesOfTheSamplesByOurClock) {
  auto& leap = fresh_leap();
  leap.age_ms = 30;
  const auto source = open_leapc_source();
  std::int64_t least_ns = INT64_MAX;
  for (int i = 0; i < 30; ++i) {
    const auto poses = next_sample(*source);
    least_ns = std::min(least_ns, now_ns() - poses.header.origin_ns);
  }
  EXPECT_GE(least_ns, to_ns(29500us)) << "younger than it is";
  EXPECT_LT(least_ns, to_ns(60ms)) << "of another clock";
}

TEST(Leapc, TheModeIsSetOnEachConnection) {
  auto& leap = fresh_leap();
  auto rig = leapc_rig();
  rig.pose.leapc.mode = config::LeapMode::screentop;
  const auto source = open_leapc_source(rig);
  next_sample(*source);
  EXPECT_EQ(leap.mode, 2);
  EXPECT_EQ(leap.policies & 1, 1u) << "frames without the focus of the desktop";
}

TEST(Leapc, AModeThatIsToBeUnchangedIsNotSet) {
  auto& leap = fresh_leap();
  auto rig = leapc_rig();
  rig.pose.leapc.mode = config::LeapMode::unchanged;
  const auto source = open_leapc_source(rig);
  next_sample(*source);
  EXPECT_EQ(leap.mode, -1);
}

TEST(Leapc, ADeviceIsChosenByItsSerialNumber) {
  auto& leap = fresh_leap();
  auto rig = leapc_rig();
  rig.pose.leapc.device = test::kFakeSerial;
  const auto source = open_leapc_source(rig);
  EXPECT_EQ(next_sample(*source).count, 1u);
  EXPECT_EQ(leap.subscriptions, 1);
}

TEST(Leapc, AnotherDeviceIsNotUsedAndTheAttachedOneIsNamed) {
  fresh_leap();
  auto rig = leapc_rig();
  rig.pose.leapc.device = "LP000";
  const auto source = open_leapc_source(rig);
  msg::HandPoses poses;
  std::string said;
  for (int i = 0; i < 20; ++i)
    if (const auto sampled = source->sample(poses, Deadline::in(50ms)); !sampled)
      said = sampled.error().what;
    else
      FAIL() << "a frame of another device";
  EXPECT_THAT(said,
              testing::AllOf(testing::HasSubstr("LP000"), testing::HasSubstr(test::kFakeSerial)));
}

TEST(Leapc, NothingIsLeftOpen) {
  auto& leap = fresh_leap();
  auto rig = leapc_rig();
  rig.pose.leapc.device = test::kFakeSerial;
  {
    const auto source = open_leapc_source(rig);
    next_sample(*source);
    EXPECT_EQ(leap.connections, 1);
  }
  EXPECT_EQ(leap.connections, 0);
  EXPECT_EQ(leap.open_devices, 0);
  EXPECT_EQ(leap.concurrent_polls, 0) << "LeapC is polled by one thread";
}

/// The bones and joints of a recording as the library would report them.
struct Recorded {
  recording::Npy joints, bones;
};
std::optional<Recorded> recorded;

void play(std::int64_t k, int, FakeHand& hand) {
  const auto sample = static_cast<std::size_t>(k) % recorded->joints.shape[0];
  for (std::size_t j = 0; j < 42; ++j)
    for (std::size_t c = 0; c < 3; ++c)
      hand.joints[j][c] = static_cast<float>(recorded->joints.values[(sample * 42 + j) * 3 + c]);
  for (std::size_t b = 0; b < 22; ++b) {
    const double* rows = &recorded->bones.values[(sample * 22 + b) * 16];
    const auto row = [&](int r) {
      return -glm::normalize(glm::dvec3(rows[4 * r], rows[4 * r + 1], rows[4 * r + 2]));
    };
    const auto q = glm::quat_cast(glm::dmat3(row(2), row(1), row(0)));
    hand.rotations[b] = {float(q.x), float(q.y), float(q.z), float(q.w)};
  }
}

TEST(Leapc, ARecordingIsReportedAsItIsRead) {
  const char* set = std::getenv("HANDCAST_DATA");
  const auto folder = std::filesystem::path(set ? set : "../shared/data") / "lmc" / "all_5s";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  recorded = Recorded{recording::read_npy(folder / "joints_left.npy").value(),
                      recording::read_npy(folder / "bones_left.npy").value()};
  const auto expected = recording::read_recording(folder).value().hands[0];
  auto& leap = fresh_leap();
  leap.motion = play;
  leap.rate_hz = 400;
  auto rig = leapc_rig();
  const auto source =
      row_of_leapc().open(rig, calib::reference_rig(), Surroundings{now_ns() + to_ns(1h)});
  ASSERT_TRUE(source) << source.error().what;
  float farthest_mm = 0;
  double most_turned = 0;
  for (int i = 0; i < 200; ++i) {
    const auto poses = next_sample(**source);
    ASSERT_EQ(poses.count, 1u);
    const auto& is = poses.hands[0];
    const auto& should = expected[poses.header.frame_id % expected.size()];
    for (int j = 0; j < msg::kJoints; ++j) {
      farthest_mm =
          std::max(farthest_mm, glm::distance(place_mm(is.joints[j]), place_mm(should.joints[j])));
      const auto &p = is.joints[j].orientation_xyzw, &q = should.joints[j].orientation_xyzw;
      const double along = std::abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]);
      most_turned = std::max(most_turned, 1 - along);
    }
  }
  EXPECT_LT(farthest_mm, 1e-3f);
  EXPECT_LT(most_turned, 1e-5);
}

}  // namespace
}  // namespace handcast::pose
