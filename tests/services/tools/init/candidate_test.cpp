// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/candidate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/tools/init/some_devices.hpp"

namespace handcast::init {
namespace {

using devices::Attached;
using testing::ElementsAre;
using testing::HasSubstr;

std::string guessed_camera(const std::vector<Attached>& attached) {
  const auto cameras = cameras_among(attached);
  return cameras[likely_camera(cameras)].word;
}

std::string guessed_light(const std::vector<Attached>& attached) {
  const auto lights = lights_among(attached);
  return lights[likely_light(lights)].word;
}

std::vector<std::string> words_of(const std::vector<Candidate>& candidates) {
  std::vector<std::string> words;
  for (const auto& candidate : candidates) words.push_back(candidate.word);
  return words;
}

Attached busy(Attached device) {
  device.trouble = "another program uses it";
  return device;
}

TEST(Guesses, AnInfraredCameraCountsMoreThanAColourOneAndAnyMoreThanTheTwin) {
  EXPECT_EQ(guessed_camera({}), "twin");
  EXPECT_EQ(guessed_camera({colour_webcam()}), "v4l2:HD Webcam");
  EXPECT_EQ(guessed_camera({colour_webcam(), infrared_webcam()}), "v4l2:IR Webcam");
  EXPECT_EQ(guessed_camera({industrial_camera(), infrared_webcam()}), "aravis:23456789");
}

TEST(Guesses, WhatCannotBeOpenedIsNotGuessed) {
  EXPECT_EQ(guessed_camera({busy(infrared_webcam()), colour_webcam()}), "v4l2:HD Webcam");
  EXPECT_EQ(guessed_camera({busy(infrared_webcam())}), "twin");
  EXPECT_EQ(guessed_light({busy(connector("HDMI-A-1", "EPSON PJ"))}), "twin");
}

TEST(Guesses, LightNeverGoesToTheOperatorsDisplayByItself) {
  EXPECT_EQ(guessed_light({}), "twin");
  EXPECT_EQ(guessed_light({monitor("eDP-1", "LCD", true)}), "twin");
  EXPECT_EQ(guessed_light({monitor("eDP-1", "LCD", true), monitor("HDMI-1", "EPSON PJ", false)}),
            "window:EPSON PJ");
  EXPECT_EQ(guessed_light({connector("eDP-1", "LCD")}), "twin");
  EXPECT_EQ(guessed_light({connector("eDP-1", "LCD"), connector("HDMI-A-1", "EPSON PJ")}),
            "kms:EPSON PJ");
}

TEST(Candidates, AreNamedByTheFirstNameThatNoOtherDeviceOfTheirDriverHas) {
  const std::vector<Attached> twins{webcam("Cam", "/dev/video0", {}),
                                    webcam("Cam", "/dev/video2", {})};
  EXPECT_THAT(words_of(cameras_among(twins)), ElementsAre("v4l2:usb-0", "v4l2:usb-2", "twin"));
  // The same display by both drivers.
  EXPECT_THAT(words_of(lights_among(
                  {monitor("HDMI-1", "EPSON PJ", false), connector("HDMI-A-1", "EPSON PJ")})),
              ElementsAre("window:EPSON PJ", "kms:EPSON PJ", "file", "twin"));
}

TEST(Candidates, ANameThatIsNoTextIsNotUsed) {
  const auto cameras = cameras_among({webcam("evil\"\n[dlp]\nred = 1 \xff", "/dev/video0", {})});
  EXPECT_THAT(words_of(cameras), ElementsAre("v4l2:usb-0", "twin"));
  EXPECT_EQ(cameras[0].text.find('\n'), std::string::npos);
}

TEST(Candidates, AreFoundByWordNameBackEndOrAPartOfTheText) {
  const auto cameras = cameras_among({industrial_camera(), colour_webcam(), infrared_webcam()});
  for (const auto* answer : {"aravis:23456789", "23456789", "acA720-520um", "aravis", "basler"})
    EXPECT_EQ(find(cameras, answer), 0u) << answer;
  EXPECT_EQ(find(cameras, "/dev/video0"), 1u);
  EXPECT_EQ(find(cameras, "ir web"), 2u);
  EXPECT_EQ(find(cameras, "twin"), 3u);
}

TEST(Candidates, AnAnswerThatMeansSeveralOrNoneIsRefusedWithThoseThatThereAre) {
  const auto cameras = cameras_among({industrial_camera(), colour_webcam(), infrared_webcam()});
  const auto several = find(cameras, "webcam");
  ASSERT_FALSE(several);
  EXPECT_EQ(several.error().code, Errc::bad_config);
  EXPECT_THAT(several.error().what, HasSubstr("can be 'v4l2:HD Webcam', 'v4l2:IR Webcam'"));
  const auto none = find(cameras, "kinect");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::unavailable);
  EXPECT_THAT(none.error().what, HasSubstr("'aravis:23456789'"));
  EXPECT_FALSE(find(cameras, "g")) << "a letter of one text is no answer";
}

}  // namespace
}  // namespace handcast::init
