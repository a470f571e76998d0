// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "calib/calibration.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/msg/owned.hpp"
#include "services/camera/camera.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;

TEST(TwinCamera, DeliversFramesWithItsClocksStampsAndNoneThatIsLost) {
  config::Rig rig;
  rig.camera.backend = "twin";
  rig.camera.rate_hz = 50;
  rig.twin.motion = "builtin:still";
  rig.twin.image.lost = 0.4;
  rig.twin.image.clock.jitter_ms = 2;
  const auto calibration = calib::reference_rig();
  const auto epoch_ns = now_ns();
  const auto twin = twin::Twin::create(rig, calibration);
  const auto camera = open_camera(rig, calibration, epoch_ns);
  ASSERT_TRUE(twin && camera);
  const auto pixels = std::size_t{720} * 540;
  msg::Owned<msg::CameraFrame> frame(sizeof(msg::CameraFrame) + pixels);
  for (int n = 0; n < 12; ++n) {
    ASSERT_TRUE((*camera)->capture(*frame, pixels, Deadline::in(5s)));
    const auto k = frame->header.frame_id;
    EXPECT_FALSE((*twin)->camera_lost(k)) << k;
    EXPECT_EQ(frame->header.origin_ns, epoch_ns + (*twin)->camera_stamp_ns(k)) << k;
  }
}

TEST(TwinCamera, ThatLosesEveryFrameHasNoneBeforeTheDeadline) {
  config::Rig rig;
  rig.camera.backend = "twin";
  rig.twin.motion = "builtin:still";
  rig.twin.image.lost = 1;
  const auto camera = open_camera(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(camera);
  const auto pixels = std::size_t{720} * 540;
  msg::Owned<msg::CameraFrame> frame(sizeof(msg::CameraFrame) + pixels);
  const auto captured = (*camera)->capture(*frame, pixels, Deadline::in(50ms));
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::timeout);
}

}  // namespace
}  // namespace handcast::camera
