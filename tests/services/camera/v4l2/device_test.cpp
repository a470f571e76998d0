// SPDX-License-Identifier: Apache-2.0
// Finding and listing cameras.
#include "services/camera/v4l2/device.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "services/camera/v4l2/list.hpp"
#include "services/camera/v4l2/stream.hpp"
#include "tests/services/camera/v4l2/emulated_webcam.hpp"

namespace handcast::camera::v4l2 {
namespace {

using test::EmulatedWebcam;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

EmulatedWebcam::Description webcam(const std::string& path, const std::string& card,
                                   const std::string& bus) {
  return {
      .path = path,
      .card = card,
      .bus = bus,
      .formats = {{.code = V4L2_PIX_FMT_YUYV, .sizes = {{640, 480, {30, 60}}, {1280, 720, {10}}}},
                  {.code = V4L2_PIX_FMT_H264, .sizes = {{640, 480}}}}};
}
EmulatedWebcam::Description first() { return webcam("/dev/video0", "Front", "usb-1"); }
EmulatedWebcam::Description second() { return webcam("/dev/video4", "Side", "usb-2"); }
EmulatedWebcam::Description metadata() {
  auto description = webcam("/dev/video1", "Front", "usb-1");
  description.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  return description;
}

std::string path_of(const std::string& wanted) {
  const auto found = find_device(wanted);
  return found ? found->identity.path : found.error().what;
}

void expect_refused(const std::string& wanted, Errc code,
                    const testing::Matcher<std::string>& text) {
  const auto refused = find_device(wanted);
  ASSERT_FALSE(refused) << wanted;
  EXPECT_EQ(refused.error().code, code) << refused.error().what;
  EXPECT_THAT(refused.error().what, text);
}

TEST(FindDevice, TheOnlyCameraNeedsNoName) {
  const EmulatedWebcam camera(first()), other(metadata());
  EXPECT_EQ(path_of(""), "/dev/video0");
}

TEST(FindDevice, IsFoundByPathNameOrBus) {
  const EmulatedWebcam camera(first()), other(second());
  EXPECT_EQ(path_of("/dev/video4"), "/dev/video4");
  EXPECT_EQ(path_of("Side"), "/dev/video4");
  EXPECT_EQ(path_of("usb-1"), "/dev/video0");
}

TEST(FindDevice, WhereSeveralFitAPersonMustChoose) {
  const EmulatedWebcam camera(first()), other(second());
  expect_refused("", Errc::bad_config,
                 HasSubstr("several cameras are attached; the cameras are 'Front' (/dev/video0, "
                           "usb-1), 'Side' (/dev/video4, usb-2); set v4l2.device"));
}

TEST(FindDevice, AnAbsentOneMayComeLater) {
  expect_refused("", Errc::unavailable, HasSubstr("no camera is attached"));
  expect_refused("/dev/video0", Errc::unavailable, HasSubstr("there is no camera '/dev/video0'"));
  const EmulatedWebcam camera(first());
  expect_refused("Rear", Errc::unavailable,
                 AllOf(HasSubstr("there is no camera 'Rear'"), HasSubstr("'Front' (/dev/video0")));
}

TEST(FindDevice, WithoutPermissionTheGroupThatHasItIsNamed) {
  EmulatedWebcam camera(first());
  camera.set({.open_fails = EACCES});
  for (const auto* wanted : {"", "/dev/video0"})
    expect_refused(wanted, Errc::bad_config, HasSubstr("sudo usermod -aG video $USER"));
  camera.set({.open_fails = EACCES, .has_no_group = true});
  expect_refused("", Errc::bad_config, HasSubstr("nor by any group"));
}

TEST(FindDevice, ADeviceThatCannotServeIsRefusedWithTheReason) {
  auto planes = first();
  planes.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  {
    const EmulatedWebcam camera(planes);
    expect_refused("", Errc::bad_config, HasSubstr("several planes"));
  }
  planes.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  const EmulatedWebcam camera(planes), other(metadata());
  expect_refused("Front", Errc::bad_config, HasSubstr("no streaming"));
  expect_refused("/dev/video1", Errc::bad_config, HasSubstr("captures no images"));
}

TEST(FindDevice, AFileThatIsNoVideoDeviceIsRefused) {
  expect_refused("/dev/null", Errc::bad_config, HasSubstr("'/dev/null' is not a video device"));
}

TEST(ListCameras, HasNamesFormatsAndSizes) {
  const EmulatedWebcam camera(first()), meta(metadata()), other(second());
  const auto cameras = list_cameras();
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(describe(cameras[0].identity), "'Front' (/dev/video0, usb-1)");
  EXPECT_EQ(describe(cameras[0].formats),
            "YUYV in 640x480 at 60 Hz, 1280x720 at 10 Hz; H264 in 640x480 at 30 Hz");
  EXPECT_TRUE(cameras[0].formats[0].is_readable);
  EXPECT_FALSE(cameras[0].formats[1].is_readable);
  EXPECT_THAT(cameras[0].trouble, IsEmpty());
  EXPECT_EQ(cameras[1].identity.path, "/dev/video4");
}

TEST(ListCameras, SaysWhyOneCannotBeUsed) {
  EmulatedWebcam locked(first());
  locked.set({.open_fails = EACCES});
  auto strange = second();
  strange.formats.erase(strange.formats.begin());
  const EmulatedWebcam unreadable(strange);
  const auto cameras = list_cameras();
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].identity.path, "/dev/video0");
  EXPECT_THAT(cameras[0].trouble, HasSubstr("the group video"));
  EXPECT_THAT(cameras[1].trouble, HasSubstr("no format that handcast reads"));
}

TEST(ListCameras, ACameraThatStreamsElsewhereIsInUseAndGoesOn) {
  const EmulatedWebcam camera(first());
  const auto device = find_device("");
  ASSERT_TRUE(device);
  v4l2_format format{.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
  ASSERT_EQ(call(device->fd.get(), VIDIOC_S_FMT, &format), 0);
  const auto stream = Stream::start(*device);
  ASSERT_TRUE(stream) << stream.error().what;
  const auto cameras = list_cameras();
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_THAT(cameras[0].trouble, HasSubstr("used by another program; `fuser /dev/video0`"));
  EXPECT_TRUE((*stream)->wait(Deadline::in(std::chrono::seconds(5))));
}

}  // namespace
}  // namespace handcast::camera::v4l2
