// SPDX-License-Identifier: Apache-2.0
// Which two sources a rig file names.
#include <gmock/gmock.h>

#include "services/pose/pose_source.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST(PairOfARig, ASecondSourceMustBeAnotherOne) {
  config::Rig rig;
  rig.pose.second = "twin";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::bad_config);
  EXPECT_THAT(source.error().what, HasSubstr("pose.second"));
  EXPECT_FALSE(check_pose_sources(rig, calib::reference_rig()));
}

TEST(PairOfARig, AnUnknownSecondSourceIsAnErrorWithTheKnownOnes) {
  config::Rig rig;
  rig.pose.second = "telepathy";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_FALSE(source);
  EXPECT_THAT(source.error().what, HasSubstr("telepathy"));
}

TEST(PairOfARig, TheTwinsTrackerComesBeforeTheLandmarks) {
  config::Rig rig;
  rig.pose.second = "none";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns()).value();
  EXPECT_GT(source->views(), 0);
  msg::HandPoses poses;
  ASSERT_TRUE(source->sample(poses, Deadline::in(5s)));
  EXPECT_EQ(poses.count, 1u);
  EXPECT_FALSE(source->depends_on_calibration());
}

}  // namespace
}  // namespace handcast::pose
