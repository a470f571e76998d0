// SPDX-License-Identifier: Apache-2.0
#include "services/camera/camera.hpp"

#include <gmock/gmock.h>

#include "ipc/msg/owned.hpp"
#include "tests/services/camera/camera_contract.hpp"
#include "tests/services/guest_ring.hpp"

namespace handcast::camera {
namespace {

/// Those that need no device or program. The tests of the others emulate theirs.
std::vector<CameraBackend> rows_without_a_device() {
  std::vector<CameraBackend> rows(camera_backends().begin(), camera_backends().end());
  std::erase_if(rows,
                [](const CameraBackend& row) { return row.exclusive || row.name == "external"; });
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Backends, CameraContract, testing::ValuesIn(rows_without_a_device()),
                         name_of_row);

TEST(ExternalCamera, PassesOnTheImagesThatAProgramSends) {
  test::GuestRing<msg::CameraFrame> program("guest.camera", msg::CameraFrame::bytes(8, 6));
  config::Rig rig;
  rig.camera.backend = "external";
  auto calibration = calib::reference_rig();
  calibration.camera.width_px = 4;
  calibration.camera.height_px = 3;
  const auto source = open_camera(rig, calibration, 0, {}, program.open());
  ASSERT_TRUE(source) << source.error().what;
  msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(4, 3));
  const auto capture = [&](std::chrono::nanoseconds span) {
    return (*source)->capture(*frame, 12, Deadline::in(span));
  };
  std::fill_n(frame->pixels(), 12, std::uint8_t{9});
  ASSERT_TRUE(capture(1ms)) << "the rig waits for a first image";
  EXPECT_EQ(frame->pixels()[11], 0);
  EXPECT_EQ(capture(1ms).error().code, Errc::timeout);
  const auto first = frame->header;

  const auto send = [&](std::uint32_t width) {
    auto sent = program.stop_in_the_middle();
    sent->header.origin_ns = now_ns();
    sent->width_px = width;
    sent->height_px = 3;
    std::fill_n(sent->pixels(), width * 3, std::uint8_t{7});
    program.send(std::move(sent));
  };
  send(4);
  ASSERT_TRUE(capture(5s));
  EXPECT_EQ(frame->pixels()[11], 7);
  EXPECT_GT(frame->header.frame_id, first.frame_id);
  EXPECT_GT(frame->header.origin_ns, first.origin_ns);
  send(8);
  const auto other = capture(5s);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::bad_data);
  EXPECT_THAT(other.error().what, testing::HasSubstr("8x3 px"));
}

TEST(ExternalCamera, TheSecondOneHasARingOfItsOwn) {
  test::GuestRing<msg::CameraFrame> program("guest.camera2", msg::CameraFrame::bytes(8, 6));
  config::Rig rig;
  rig.camera2.backend = "external";
  auto calibration = calib::reference_rig();
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, glm::dmat4(1)};
  std::string asked;
  const auto source =
      open_camera(rig, calibration, 0, config::Viewpoint::second, [&](std::string_view stream) {
        asked = stream;
        return program.open()(stream);
      });
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(asked, "guest.camera2");
}

TEST(Camera, AnUnknownBackEndIsRefusedWithTheKnownOnesNamed) {
  config::Rig rig;
  rig.camera.backend = "polaroid";
  const auto opened = open_camera(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what,
              testing::AllOf(testing::HasSubstr("polaroid"), testing::HasSubstr("twin, replay")));
}

}  // namespace
}  // namespace handcast::camera
