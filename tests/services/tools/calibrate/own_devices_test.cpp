// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tools/calibrate/rig_settings.hpp"

namespace handcast::calibrate {
namespace {

using devices::Attached, devices::Kind;

const Attached kWebcam{
    .kind = Kind::camera,
    .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", "/dev/video0"}},
    .names = {"HD Webcam", "usb-1.2", "/dev/video0"}};
const Attached kOtherWebcam{
    .kind = Kind::camera,
    .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", "/dev/video2"}},
    .names = {"Other Webcam", "usb-1.3", "/dev/video2"}};
const Attached kProjector{.kind = Kind::display,
                          .settings = {{"projector.backend", "window"}},
                          .names = {"EPSON PJ", "HDMI-1"}};

config::Rig rig(std::string camera, std::string monitor) {
  config::Rig rig;
  rig.camera.backend = "v4l2";
  rig.camera.v4l2.device = std::move(camera);
  rig.projector.backend = "window";
  rig.projector.window.monitor = std::move(monitor);
  return rig;
}

TEST(OwnDevices, TheOnlyOnesAreMeantByARigThatNamesNone) {
  const auto own = own_devices(rig("", ""), {kWebcam, kProjector});
  EXPECT_EQ(own.camera, "HD Webcam");
  EXPECT_EQ(own.projector, "EPSON PJ");
}

TEST(OwnDevices, APlaceLeadsToTheDeviceThatIsThere) {
  const auto own = own_devices(rig("/dev/video2", "HDMI-1"), {kWebcam, kOtherWebcam, kProjector});
  EXPECT_EQ(own.camera, "Other Webcam");
  EXPECT_EQ(own.projector, "EPSON PJ");
}

TEST(OwnDevices, OfSeveralNoneIsMeantUnlessTheRigNamesIt) {
  EXPECT_EQ(own_devices(rig("", ""), {kWebcam, kOtherWebcam}).camera, "");
  EXPECT_EQ(own_devices(rig("usb-1.2", ""), {kWebcam, kOtherWebcam}).camera, "HD Webcam");
}

TEST(OwnDevices, ADeviceThatIsNotFoundKeepsTheRigsNameButNoPlace) {
  const auto named = own_devices(rig("HD Webcam", "EPSON PJ"), {});
  EXPECT_EQ(named.camera, "HD Webcam");
  EXPECT_EQ(named.projector, "EPSON PJ");
  const auto placed = own_devices(rig("/dev/video0", "1"), {});
  EXPECT_EQ(placed.camera, "");
  EXPECT_EQ(placed.projector, "");
}

TEST(OwnDevices, TheSecondCameraHasItsOwnNames) {
  auto two = rig("usb-1.2", "");
  two.camera2.backend = "v4l2";
  two.camera2.v4l2.device = "/dev/video2";
  const auto own = own_devices(two, {kWebcam, kOtherWebcam});
  EXPECT_EQ(own.camera, "HD Webcam");
  EXPECT_EQ(own.camera2, "Other Webcam");
  EXPECT_EQ(own.camera2_names,
            (std::vector<std::string>{"Other Webcam", "usb-1.3", "/dev/video2"}));
}

TEST(OwnDevices, TheTwinHasNone) {
  const auto own = own_devices(config::Rig(), {kWebcam, kProjector});
  EXPECT_EQ(own.camera, "");
  EXPECT_EQ(own.projector, "");
}

}  // namespace
}  // namespace handcast::calibrate
