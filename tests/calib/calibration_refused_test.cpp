// SPDX-License-Identifier: Apache-2.0
// Calibration files that no rig can have.
#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "calib/calibration.hpp"
#include "tests/calib/calibration_files.hpp"

namespace handcast::calib {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// The file of the reference rig with these sections and settings ("[camera]\nwidth_px = 0\n")
/// instead of its own.
std::filesystem::path reference_with(const std::string& changes) {
  std::istringstream changed(changes), reference(print_calibration(reference_rig()));
  std::map<std::string, std::string> wanted;  // by section and name
  std::string section, text;
  for (std::string line; std::getline(changed, line);) {
    if (line.starts_with('[')) section = line;
    if (const auto equals = line.find(" ="); equals != line.npos)
      wanted[section + line.substr(0, equals)] = line;
  }
  for (std::string line; std::getline(reference, line);) {
    if (line.starts_with('[')) section = line;
    const auto found = wanted.find(section + line.substr(0, line.find(" =")));
    text += (found == wanted.end() ? line : found->second) + '\n';
  }
  return file_with(text);
}

TEST(CalibrationFile, SaysWhatIsWrongAndWhere) {
  const auto rig = load_calibration(reference_with("[camera]\nwidth_px = 0\nfocal_px = [5]\n"));
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, Errc::bad_config);
  EXPECT_THAT(rig.error().what, ContainsRegex("toml:[0-9]+: camera.width_px: 0 is outside 16"));
  EXPECT_THAT(rig.error().what,
              HasSubstr("camera.focal_px: must be a list of 2 numbers, not of 1"));
}

TEST(CalibrationFile, RefusesAMirroredTracker) {
  const auto rig = load_calibration(reference_with(
      "[camera_from_tracker]\nx = [1, 0, 0, 0]\ny = [0, 1, 0, 0]\nz = [0, 0, -1, 0]\n"));
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("not a right-handed rotation"));
}

TEST(CalibrationFile, RefusesATrackerWhoseAxesSpanNoSpace) {
  for (const char* rows : {"x = [0, 0, 0, 0]\ny = [0, 0, 0, 0]\nz = [0, 0, 0, 0.3]\n",
                           "x = [1, 1, 0, 0]\ny = [0, 0, 0, 0]\nz = [0, 0, 1, 0]\n"}) {
    const auto rig =
        load_calibration(reference_with(std::string("[camera_from_tracker]\n") + rows));
    ASSERT_FALSE(rig) << rows;
    EXPECT_THAT(rig.error().what, HasSubstr("not a right-handed rotation"));
  }
}

TEST(CalibrationFile, RefusesALensThatFoldsTheImageAndNoOther) {
  for (const char* lens :
       {"[-2, 0, 0, 0, 0]", "[-1.2, 0, 0, 0, 0]", "[0, -20, 0, 0, 0]", "[0, 0, 2, 0, 0]"}) {
    const auto rig =
        load_calibration(reference_with(std::string("[camera]\ndistortion = ") + lens));
    ASSERT_FALSE(rig) << lens;
    EXPECT_THAT(rig.error().what, HasSubstr("folds the image"));
  }
  for (const char* lens : {"[0, 0, 0, 0, 0]", "[-0.8, 0, 0, 0, 0]", "[1, 0, 0.01, 0.01, 0]"})
    EXPECT_TRUE(load_calibration(reference_with(std::string("[camera]\ndistortion = ") + lens)))
        << lens;
}

TEST(CalibrationFile, RefusesAHomographyWithoutAnInverse) {
  const auto rig = load_calibration(
      reference_with("[projector]\nx = [1, 0, 0]\ny = [2, 0, 0]\nw = [0, 0, 1]\n"));
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("homography"));
}

TEST(CalibrationFile, RefusesAHomographyThatNoCoaxialRigHas) {
  const std::pair<const char*, const char*> kFaults[] = {
      {"x = [-1, 0, 0]", "beside the camera image"},
      {"x = [1e300, 0, 0]", "homography"},
      {"w = [0, 0, 1e-9]", "homography"},
      {"w = [0.01, 0.01, -3]", "the horizon of the homography"},
      {"x = [100, 0, -36000]\ny = [0, 100, -27000]", "shrinks the projector's image to a spot"},
      {"x = [0.1, 0, 0]\ny = [0, 0.1, 0]", "far outside the camera image"},
  };
  for (const auto& [rows, sentence] : kFaults) {
    const auto rig = load_calibration(reference_with(std::string("[projector]\n") + rows));
    ASSERT_FALSE(rig) << rows;
    EXPECT_THAT(rig.error().what, HasSubstr(sentence)) << rows;
  }
}

TEST(CalibrationFile, RefusesAParallaxThatNoProjectorHas) {
  for (const char* parallax : {"[1e6, 0, 0]", "[0, -1e5, 0]", "[0, 0, 50]", "[20000, 0, 0]"}) {
    const auto rig =
        load_calibration(reference_with(std::string("[projector]\nparallax = ") + parallax));
    ASSERT_FALSE(rig) << parallax;
    EXPECT_THAT(rig.error().what, HasSubstr("projector.parallax: at 0.")) << parallax;
  }
  // A projector 0.6 m beside the camera, or above it, and one farther back.
  for (const char* parallax : {"[1000, 0, 0]", "[-1000, 0, 0]", "[0, 1000, 0]", "[150, 100, 0.3]"})
    EXPECT_TRUE(
        load_calibration(reference_with(std::string("[projector]\nparallax = ") + parallax)))
        << parallax;
}

TEST(CalibrationFile, AcceptsAMirrorAndAScreenThatCoversAPart) {
  for (const char* rows : {"x = [-1.42, 0, 1023]\ny = [0, 1.42, 0]\nw = [0, 0, 1]",
                           "x = [0.7, 0, 500]\ny = [0, 0.7, 300]\nw = [0, 0, 1]",
                           "x = [4, 0, -700]\ny = [0, 4, -500]\nw = [0, 0, 1]"}) {
    const auto rig = load_calibration(reference_with(std::string("[projector]\n") + rows));
    EXPECT_TRUE(rig) << rows << ": " << rig.error().what;
  }
}

TEST(CalibrationFile, RefusesScreensAndLensesThatNoCameraHas) {
  const std::pair<const char*, const char*> kFaults[] = {
      {"[camera]\nwidth_px = 8000\nheight_px = 8000", "camera: 8000 x 8000 px are too many"},
      {"[projector]\nwidth_px = 8000\nheight_px = 8000", "projector: 8000 x 8000 px are too many"},
      {"[camera]\nfocal_px = [1, 1]", "camera.focal_px: 1 px is not plausible"},
      {"[camera]\nfocal_px = [1e6, 1e6]", "camera.focal_px"},
      {"[camera]\ncentre_px = [1e5, -1e5]", "camera.centre_px"},
  };
  for (const auto& [text, sentence] : kFaults) {
    const auto rig = load_calibration(reference_with(text));
    ASSERT_FALSE(rig) << text;
    EXPECT_THAT(rig.error().what, HasSubstr(sentence)) << text;
  }
}

TEST(CalibrationFile, RefusesATrackerFarAway) {
  const auto rig = load_calibration(reference_with(
      "[camera_from_tracker]\nx = [1, 0, 0, 350]\ny = [0, 1, 0, 0]\nz = [0, 0, 1, 0]\n"));
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("350 m away from the camera"));
}

}  // namespace
}  // namespace handcast::calib
