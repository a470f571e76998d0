// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watched_source.hpp"

#include <gtest/gtest.h>

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;

TEST(WatchedSource, ATrackerThatFreezesIsCountedOnceAndItsHandsAreNotBelieved) {
  config::Rig rig;
  rig.twin.motion = "builtin:wave";
  rig.twin.tracker.frozen = {0.3, 60};
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns()).value();
  msg::TrackerFaults faults;
  msg::HandPoses poses;
  for (int i = 0; i < 80; ++i) {
    ASSERT_TRUE(source->sample(poses, Deadline::in(5s)));
    faults += source->take_faults();
  }
  EXPECT_EQ(faults.of(msg::TrackerFault::frozen), 1u);
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.hands[0].confidence, 0);
}

TEST(WatchedSource, FaultsAreTakenOnce) {
  config::Rig rig;
  rig.twin.motion = "builtin:wave";
  rig.twin.tracker.frozen = {0.1, 60};
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns()).value();
  msg::HandPoses poses;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(source->sample(poses, Deadline::in(5s)));
  EXPECT_NE(source->take_faults(), msg::TrackerFaults{});
  EXPECT_EQ(source->take_faults(), msg::TrackerFaults{});
}

}  // namespace
}  // namespace handcast::pose
