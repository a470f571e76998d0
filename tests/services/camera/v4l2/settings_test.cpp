// SPDX-License-Identifier: Apache-2.0
// What is asked from a webcam before it streams.
#include <gmock/gmock.h>

#include <cerrno>

#include "ipc/base/log.hpp"
#include "tests/services/camera/v4l2/webcam_test.hpp"

namespace handcast::camera {
namespace {

using config::WebcamFormat;
using test::EmulatedControl;
using test::EmulatedWebcam;
using testing::AllOf;
using testing::HasSubstr;

class WebcamSettings : public test::WebcamTest {
 protected:
  /// The log lines while the camera is opened.
  std::string log_of_opening() {
    testing::internal::CaptureStderr();
    open();
    return testing::internal::GetCapturedStderr();
  }
};

TEST_F(WebcamSettings, AutoTakesTheFirstFormatOfTheListThatTheCameraHas) {
  auto description = test::small_webcam();
  for (const auto* word : {"GREY", "Y16", "Y10", "NV12", "YUYV", "MJPEG"}) {
    const EmulatedWebcam webcam(description);
    EXPECT_THAT(log_of_opening(), HasSubstr(std::string("sends ") + word + " 64x48 at 100 Hz"));
    camera_.reset();
    description.formats.pop_back();
  }
}

TEST_F(WebcamSettings, AutoTakesAFormatThatHasTheSize) {
  auto description = test::small_webcam();
  for (auto& format : description.formats)
    if (format.code != V4L2_PIX_FMT_YUYV) format.sizes = {{640, 480}};
  const EmulatedWebcam webcam(description);
  EXPECT_THAT(log_of_opening(), HasSubstr("sends YUYV"));
}

TEST_F(WebcamSettings, ASizeThatTheCameraLacksIsRefusedWithThoseThatItHas) {
  calibration_.camera.width_px = 65;
  const EmulatedWebcam webcam(test::small_webcam());
  expect_refused(Errc::bad_config, AllOf(HasSubstr("65x48 px, the size in the calibration"),
                                         HasSubstr("GREY in 64x48 at 250 Hz, 33x17 at 100 Hz")));
}

TEST_F(WebcamSettings, AFormatThatTheCameraLacksIsRefusedWithThoseThatItHas) {
  auto description = test::small_webcam();
  description.formats.pop_back();
  const EmulatedWebcam webcam(description);
  rig_.camera.v4l2.format = WebcamFormat::grey;
  expect_refused(Errc::bad_config, AllOf(HasSubstr("has no GREY image of 64x48 px"),
                                         HasSubstr("it has MJPEG in 64x48")));
}

TEST_F(WebcamSettings, HalfImagesAreRefused) {
  auto description = test::small_webcam();
  description.field = V4L2_FIELD_INTERLACED;
  const EmulatedWebcam webcam(description);
  expect_refused(Errc::bad_config, HasSubstr("interlaced"));
}

TEST_F(WebcamSettings, TheRateThatIsHeldIsReported) {
  const EmulatedWebcam webcam(test::small_webcam());
  rig_.camera.rate_hz = 525;
  EXPECT_THAT(log_of_opening(), HasSubstr("at 250 Hz instead of 525 Hz"));
}

TEST_F(WebcamSettings, ADriverThatDoesNotSayItsRateIsUsed) {
  auto description = test::small_webcam();
  description.says_its_rate = false;
  const EmulatedWebcam webcam(description);
  EXPECT_THAT(log_of_opening(), HasSubstr("does not say at which rate"));
  EXPECT_TRUE(capture());
}

TEST_F(WebcamSettings, TheExposureIsSetAndNoLongerAutomatic) {
  const EmulatedWebcam webcam(test::small_webcam());
  rig_.camera.exposure_ms = 1.85;
  ASSERT_TRUE(open());
  EXPECT_EQ(webcam.value_of(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(webcam.value_of(V4L2_CID_EXPOSURE_ABSOLUTE), 19);
  ASSERT_TRUE(capture());
  EXPECT_EQ(frame().exposure_ns, 1'900'000) << "what the camera holds";
}

TEST_F(WebcamSettings, AnExposureOutOfRangeIsRefusedWithTheRange) {
  const EmulatedWebcam webcam(test::small_webcam());
  rig_.camera.exposure_ms = 0.2;
  expect_refused(Errc::bad_config, HasSubstr("cannot expose for 0.2 ms (exposure_ms); it "
                                             "can for 0.3 to 204.7 ms"));
}

TEST_F(WebcamSettings, ACameraWithoutExposureControlsIsUsedAndSaysSo) {
  auto description = test::small_webcam();
  description.controls.clear();
  const EmulatedWebcam webcam(description);
  EXPECT_THAT(log_of_opening(), HasSubstr("does not let programs set its exposure"));
  ASSERT_TRUE(capture());
  EXPECT_EQ(frame().exposure_ns, 2'000'000);
  EXPECT_GE(frame().origin_error_ns, 1'000'000) << "it is only assumed";
}

TEST_F(WebcamSettings, AnExposureThatStaysAutomaticIsNotTakenForKnown) {
  const EmulatedWebcam webcam(test::small_webcam());
  rig_.camera.v4l2.controls = {"auto_exposure=3"};
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  EXPECT_EQ(webcam.value_of(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_GE(frame().origin_error_ns, 1'000'000);
}

TEST_F(WebcamSettings, ControlsAreSetInTheirOrder) {
  const EmulatedWebcam webcam(test::small_webcam());
  rig_.camera.v4l2.controls = {"gain=20", "power_line_frequency=50 Hz", "gain=21",
                               "exposure_time_absolute=30"};
  ASSERT_TRUE(open());
  EXPECT_EQ(webcam.value_of(V4L2_CID_GAIN), 21);
  EXPECT_EQ(webcam.value_of(V4L2_CID_POWER_LINE_FREQUENCY), 1);
  ASSERT_TRUE(capture());
  EXPECT_EQ(frame().exposure_ns, 3'000'000);
}

TEST_F(WebcamSettings, AControlThatCannotBeSetIsRefusedWithTheReason) {
  auto description = test::small_webcam();
  const auto add = [&](std::uint32_t id, v4l2_ctrl_type type, const char* title,
                       std::uint32_t flags) {
    description.controls.push_back(
        {.id = id, .type = type, .title = title, .most = 9, .flags = flags});
  };
  add(V4L2_CID_BRIGHTNESS, V4L2_CTRL_TYPE_INTEGER, "Brightness", V4L2_CTRL_FLAG_READ_ONLY);
  add(V4L2_CID_CONTRAST, V4L2_CTRL_TYPE_INTEGER, "Contrast", V4L2_CTRL_FLAG_INACTIVE);
  add(V4L2_CID_HUE, V4L2_CTRL_TYPE_INTEGER, "Hue", V4L2_CTRL_FLAG_GRABBED);
  add(V4L2_CID_SHARPNESS, V4L2_CTRL_TYPE_STRING, "Sharpness", 0);
  add(V4L2_CID_GAMMA, V4L2_CTRL_TYPE_INTEGER, "Gamma", V4L2_CTRL_FLAG_DISABLED);
  const EmulatedWebcam webcam(description);
  for (const auto& [assignment, reason] : std::vector<std::pair<std::string, std::string>>{
           {"brightness=1", "brightness can only be read"},
           {"contrast=1", "contrast is inactive"},
           {"hue=1", "hue is locked"},
           {"sharpness=1", "sharpness is a text"},
           {"gamma=1", "has no control 'gamma'; it has brightness, contrast"},
           {"gain=256", "gain cannot be '256'; it accepts 0 to 255"},
           {"power_line_frequency=3", "0 (Disabled), 1 (50 Hz), 2 (60 Hz)"},
           {"gain", "'gain' is not of the form name=value"}}) {
    rig_.camera.v4l2.controls = {assignment};
    expect_refused(Errc::bad_config, HasSubstr(reason));
  }
}

TEST_F(WebcamSettings, ValuesThatTheCameraChangesAreReported) {
  auto description = test::small_webcam();
  description.controls.push_back({.id = V4L2_CID_ZOOM_ABSOLUTE,
                                  .title = "Zoom",
                                  .most = 9,
                                  .flags = V4L2_CTRL_FLAG_WRITE_ONLY});
  description.controls.push_back(
      {.id = V4L2_CID_PAN_RESET, .type = V4L2_CTRL_TYPE_BUTTON, .title = "Pan, Reset"});
  const EmulatedWebcam webcam(description);
  rig_.camera.v4l2.controls = {"zoom=4", "pan_reset=1"};
  EXPECT_THAT(log_of_opening(), testing::Not(HasSubstr("instead of")));
  EXPECT_EQ(webcam.value_of(V4L2_CID_ZOOM_ABSOLUTE), 4);
}

TEST_F(WebcamSettings, ABusyCameraIsUnavailable) {
  const EmulatedWebcam webcam(test::small_webcam());
  ASSERT_TRUE(open());
  const auto held = std::move(camera_);
  expect_refused(Errc::unavailable, HasSubstr("is used by another program; `fuser /dev/video0`"));
}

TEST_F(WebcamSettings, TooLittleBandwidthHasItsRemedy) {
  EmulatedWebcam webcam(test::small_webcam());
  webcam.set({.stream_fails = ENOSPC});
  expect_refused(Errc::unavailable, HasSubstr("set v4l2.format to MJPEG"));
  EXPECT_EQ(webcam.buffers(), 0) << "the buffers are given back";
}

TEST_F(WebcamSettings, AnAbsentCameraMayComeLater) {
  expect_refused(Errc::unavailable, HasSubstr("no camera is attached"));
}

}  // namespace
}  // namespace handcast::camera
