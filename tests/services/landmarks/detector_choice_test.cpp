// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>

#include "config/rig.hpp"
#include "services/landmarks/detector.hpp"
#include "tests/scratch.hpp"

namespace handcast::landmarks {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A rig with MediaPipe's networks in a folder that has neither of their files.
class DetectorChoiceTest : public testing::Test {
 protected:
  DetectorChoiceTest() {
    rig_.landmarks.backend = "mediapipe";
    rig_.landmarks.fallback = "twin";
    rig_.landmarks.models = folder_.path().string();
  }
  void write(const char* name) { std::ofstream(folder_.path() / name) << "no network"; }

  test::Scratch folder_;
  config::Rig rig_;
};

TEST_F(DetectorChoiceTest, AMissingFileMakesTheFallbackTakeOverAndIsNamed) {
  const auto choice = choose_detector(rig_);
  EXPECT_EQ(choice.backend, "twin");
  EXPECT_THAT(choice.why, AllOf(HasSubstr("hand_landmark_lite.onnx' is missing"),
                                HasSubstr("'twin' takes the place of 'mediapipe'")));
  const auto detector = open_detector(rig_, calib::reference_rig(), 0);
  EXPECT_TRUE(detector) << detector.error().what;
  write("hand_landmark_lite.onnx");
  EXPECT_THAT(choose_detector(rig_).why, HasSubstr("palm_detection_lite.onnx' is missing"));
}

TEST_F(DetectorChoiceTest, WithoutAFallbackAMissingFileIsAnError) {
  rig_.landmarks.fallback.clear();
  EXPECT_EQ(choose_detector(rig_).backend, "mediapipe");
  const auto detector = open_detector(rig_, calib::reference_rig(), 0);
  ASSERT_FALSE(detector);
  EXPECT_THAT(detector.error().what, HasSubstr("hand_landmark_lite.onnx' is missing"));
}

TEST_F(DetectorChoiceTest, ADamagedFileIsAnErrorAndNoReasonForTheFallback) {
  write("hand_landmark_lite.onnx");
  write("palm_detection_lite.onnx");
  const auto choice = choose_detector(rig_);
  EXPECT_EQ(choice.backend, "mediapipe");
  EXPECT_EQ(choice.why, "");
  EXPECT_FALSE(open_detector(rig_, calib::reference_rig(), 0));
}

TEST_F(DetectorChoiceTest, AFolderThatDoesNotExistIsAWrongSettingAndNoReasonForTheFallback) {
  rig_.landmarks.models += "/nowhere";
  EXPECT_EQ(choose_detector(rig_).backend, "mediapipe");
  EXPECT_FALSE(open_detector(rig_, calib::reference_rig(), 0));
}

TEST_F(DetectorChoiceTest, AFallbackThatThisBuildDoesNotHaveIsNamed) {
  rig_.landmarks.fallback = "eagle";
  const auto detector = open_detector(rig_, calib::reference_rig(), 0);
  ASSERT_FALSE(detector);
  EXPECT_THAT(detector.error().what, HasSubstr("no back end 'eagle'"));
}

}  // namespace
}  // namespace handcast::landmarks
