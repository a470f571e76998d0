// SPDX-License-Identifier: Apache-2.0
// The contract of the pose back ends that need no device, and tests of single ones.
#include <gmock/gmock.h>

#include <vector>

#include "tests/services/guest_ring.hpp"
#include "tests/services/pose/pose_contract.hpp"

namespace handcast::pose {
namespace {

/// Back ends with tests of their own, which put something in the place of the device or program.
constexpr std::array<std::string_view, 2> kDevices{"external", "leapc"};

std::vector<PoseBackend> without_devices() {
  std::vector<PoseBackend> rows;
  for (const auto& row : pose_backends())
    if (std::ranges::find(kDevices, row.name) == kDevices.end()) rows.push_back(row);
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Backends, PoseContract, testing::ValuesIn(without_devices()), name_of_row);

TEST(TwinPose, AnArrivingSampleIsAsOldAsTheRigSays) {
  config::Rig rig;
  rig.twin.tracker.age_ms = 30;
  rig.twin.tracker.age_sd_ms = 0;
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  for (int i = 0; i < 5; ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
    EXPECT_GE(now_ns() - poses.header.origin_ns, to_ns(30ms) - to_ns(1us));
  }
}

TEST(TwinPose, ALostSampleIsDeliveredWithoutAHand) {
  config::Rig rig;
  rig.twin.tracker.dropout = 1;
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  msg::HandPoses poses;
  ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
  EXPECT_EQ(poses.count, 0u);
}

TEST(ExternalPose, PassesOnWhatAProgramSends) {
  test::GuestRing<msg::HandPoses> program("guest.pose");
  config::Rig rig;
  rig.pose.backend = "external";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns(), program.open());
  ASSERT_TRUE(source) << source.error().what;
  const auto twin = twin::Twin::create(rig, calib::reference_rig()).value();
  msg::HandPoses first;
  ASSERT_TRUE((*source)->sample(first, Deadline::in(1ms))) << "the rig waits for a first sample";
  EXPECT_EQ(first.count, 0u);
  EXPECT_FALSE((*source)->sample(first, Deadline::in(1ms)));
  std::uint64_t last = first.header.frame_id;
  for (std::uint64_t k = 0; k < 3; ++k) {
    auto sent = twin->tracker_sample(k).poses;
    sent.header = {99, now_ns(), 0};
    sent.calibration = 77;
    program.send(sent);
    msg::HandPoses poses;
    ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
    EXPECT_GT(poses.header.frame_id, last) << "the numbers of a program need not increase";
    last = poses.header.frame_id;
    EXPECT_EQ(poses.header.origin_ns, sent.header.origin_ns);
    EXPECT_EQ(poses.hands[0].joints[10].position_m, sent.hands[0].joints[10].position_m);
    EXPECT_EQ(poses.calibration, 0u);
  }
}

TEST(ExternalPose, IsRefusedWithoutARigButNotByACheck) {
  config::Rig rig;
  rig.pose.backend = "external";
  EXPECT_THAT(open_pose_source(rig, calib::reference_rig(), 0).error().what,
              testing::HasSubstr("a rig that is up"));
  EXPECT_TRUE(check_pose_sources(rig, calib::reference_rig()));
}

TEST(StereoPose, NeedsASecondCameraInTheCalibration) {
  config::Rig rig;
  rig.pose.backend = "stereo";
  rig.camera2.backend = "twin";
  const auto opened = open_pose_source(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, testing::HasSubstr("[camera2_from_camera]"));
}

TEST(StereoPose, NeedsASecondCamera) {
  config::Rig rig;
  rig.pose.backend = "stereo";
  EXPECT_THAT(check_pose_sources(rig, two_cameras()).error().what,
              testing::HasSubstr("set camera2.backend"));
  rig.camera.backend = "leap";  // which has two eyes
  EXPECT_TRUE(check_pose_sources(rig, two_cameras()));
}

TEST(StereoPose, TheLandmarksOfOneViewWaitForThoseOfTheOther) {
  config::Rig rig;
  rig.pose.backend = "stereo";
  rig.camera2.backend = "twin";
  rig.pose.stereo.wait_ms = 100;
  const auto source = open_pose_source(rig, two_cameras(), 0).value();
  const auto seen = twin::Twin::create(rig, two_cameras()).value()->detect(0, 0, 0).landmarks;
  msg::HandPoses poses;
  EXPECT_EQ(source->awaited_view(), 0);
  source->see(seen, 0);
  EXPECT_EQ(source->awaited_view(), 1);
  EXPECT_FALSE(source->sample(poses, Deadline::now()));
  EXPECT_TRUE(source->sample(poses, Deadline::in(5s))) << "until wait_ms";
}

TEST(ReplayPose, PlaysWhatWasRecorded) {
  test::Scratch scratch;
  config::Rig rig;
  const auto recording = recording_of(rig);
  ASSERT_TRUE(recording::write_recording(scratch.path(), recording));
  rig.pose.backend = "replay";
  rig.pose.replay.directory = scratch.path();
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(source) << source.error().what;
  for (int i = 0; i < 5; ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE((*source)->sample(poses, Deadline::in(5s)));
    const auto& expected = recording.hands[0][poses.header.frame_id % 30];
    for (const int tip : {5, 10, 15, 20, 25})
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(poses.hands[0].joints[tip].position_m[axis],
                    expected.joints[tip].position_m[axis], 1e-5);
  }
}

TEST(ReplayPose, SaysWhatItMisses) {
  config::Rig rig;
  rig.pose.backend = "replay";
  EXPECT_THAT(open_pose_source(rig, calib::reference_rig(), 0).error().what,
              testing::HasSubstr("pose.replay.directory"));
  rig.pose.replay.directory = "/nowhere";
  const auto opened = open_pose_source(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, testing::HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace handcast::pose
