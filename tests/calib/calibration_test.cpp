// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <map>
#include <sstream>

#include "config/settings/files.hpp"
#include "config/settings/frozen_file.hpp"

namespace handcast::calib {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::filesystem::path file_with(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "handcast_calibration_test.toml";
  std::ofstream(file) << text;
  return file;
}

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

double largest_difference(const auto& a, const auto& b) {
  double largest = 0;
  for (int column = 0; column < a.length(); ++column)
    for (int row = 0; row < a[0].length(); ++row)
      largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
  return largest;
}

/// The bytes of a file of the calibration that the authors of the paper published; empty if the
/// external data is missing.
std::string published(const std::string& name) {
  const char* data = std::getenv("HANDCAST_DATA");
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto folder = data ? std::filesystem::path(data)
                           : std::filesystem::path(source ? source : ".") / "../shared/data";
  std::ifstream stream(folder / "calibration" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The numbers of the uncompressed array `name` (".npy") in a file. They start after the line of
/// its header.
template <class Number>
std::vector<Number> numbers_of(const std::string& bytes, const std::string& name,
                               std::size_t count) {
  const auto data = bytes.find('\n', bytes.find("\x93NUMPY", bytes.find(name))) + 1;
  std::vector<Number> numbers(count);
  std::memcpy(numbers.data(), bytes.data() + data, count * sizeof(Number));
  return numbers;
}

TEST(ReferenceRig, HasTheLensItsAuthorsPublished) {
  const auto bytes = published("cam_calibration.npz");
  if (bytes.empty())
    GTEST_SKIP()
        << "calibration/cam_calibration.npz is missing in ../shared/data or $HANDCAST_DATA";
  const auto lens = numbers_of<double>(bytes, "cam_distortion.npy", 5);
  const auto matrix = numbers_of<double>(bytes, "cam_intrinsics.npy", 9);
  const auto camera = reference_rig().camera;
  const double ours[] = {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(ours[i], lens[i], 1e-8) << i;
  EXPECT_LT(largest_difference(camera.matrix(), glm::transpose(glm::make_mat3(matrix.data()))),
            1e-3);
}

TEST(ReferenceRig, PlacesTheTrackerWhereItsAuthorsPublished) {
  const auto bytes = published("w2c.npy");
  if (bytes.empty())
    GTEST_SKIP() << "calibration/w2c.npy is missing in ../shared/data or $HANDCAST_DATA";
  // A camera as in OpenGL: y up, z backward, in mm.
  auto view = glm::dmat4(glm::make_mat4(numbers_of<float>(bytes, "", 16).data()));
  view[3] *= glm::dvec4(1e-3, 1e-3, 1e-3, 1);
  const glm::dmat4 flip(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
  EXPECT_LT(largest_difference(reference_rig().camera_from_tracker, flip * view), 1e-6);
}

TEST(ReferenceRig, PlacesTheTrackerByARightHandedRotation) {
  const auto transform = reference_rig().camera_from_tracker;
  const glm::dmat3 rotation(transform);
  EXPECT_NEAR(glm::determinant(rotation), 1, 1e-12);
  EXPECT_LT(largest_difference(rotation * glm::transpose(rotation), glm::dmat3(1)), 1e-12);
}

TEST(ReferenceRig, HasItsCameraWhereTheAuthorsMeasuredItInMetres) {
  const auto origin = glm::inverse(reference_rig().camera_from_tracker)[3];
  EXPECT_NEAR(origin.x, -0.0469, 1e-4);
  EXPECT_NEAR(origin.y, -0.1607, 1e-4);
  EXPECT_NEAR(origin.z, 0.4600, 1e-4);
}

TEST(ReferenceRig, SeesTheHandsPlaceInTheMiddleOfTheImage) {
  const auto rig = reference_rig();
  const auto hand = rig.camera_from_tracker * glm::dvec4(-0.06, 0.2, 0.01, 1);
  ASSERT_GT(hand.z, 0);
  const auto px = rig.camera.project(hand);
  EXPECT_GT(px.x, 0);
  EXPECT_LT(px.x, rig.camera.width_px);
}

TEST(ReferenceRig, CoversTheProjectorsPictureWithTheCamerasToTwoPercent) {
  const auto rig = reference_rig();
  const glm::dvec2 last(rig.projector_width_px - 1, rig.projector_height_px - 1);
  EXPECT_LT(glm::distance(rig.to_projector({359.5, 269.5}), last / 2.0), 1e-9);
  EXPECT_LT(glm::distance(rig.to_projector({-0.1, -0.1}), {0, 0}), 10);
  EXPECT_LT(glm::distance(rig.to_projector({719, 539}), last), 10);
}

TEST(ReferenceRig, HasATrueHomography) {
  const auto rig = reference_rig();
  const auto left = rig.to_projector({0, 269}), middle = rig.to_projector({359, 269}),
             right = rig.to_projector({718, 269});
  EXPECT_GT(std::abs(glm::distance(left, middle) - glm::distance(middle, right)), 0.5)
      << "no keystone";
  EXPECT_GT(std::abs(right.y - left.y), 3) << "not turned";
}

TEST(Calibration, ToCameraIsTheInverseOfToProjector) {
  const auto rig = reference_rig();
  for (double x : {0.0, 300.5, 1023.0})
    for (double y : {0.0, 200.25, 767.0})
      EXPECT_LT(glm::distance(rig.to_projector(rig.to_camera({x, y})), {x, y}), 1e-9);
}

Calibration rig_with_projector_beside() {
  auto rig = reference_rig();
  rig.plane_m = 0.7;
  rig.parallax = -(rig.projector_from_camera * (rig.camera.matrix() * glm::dvec3(0.15, 0.02, 0)));
  return rig;
}

TEST(Calibration, ACoaxialProjectorLightsAPixelAtEveryDepth) {
  const auto rig = reference_rig();
  EXPECT_EQ(rig.to_projector({200, 300}, 0.4), rig.to_projector({200, 300}));
}

TEST(Calibration, AProjectorBesideTheCameraHasTheParallaxOfItsPlace) {
  const auto rig = rig_with_projector_beside();
  const glm::dvec2 px(200, 300);
  EXPECT_LT(glm::distance(rig.to_projector(px, rig.plane_m), rig.to_projector(px)), 1e-9);
  // Seen from 0.15 m further to the right, a point that is nearer than the plane lies to the left:
  // by 0.15 m times the focal length times the difference of the inverse depths.
  const double shift_px = 0.15 * rig.camera.fx_px * (1 / 0.5 - 1 / 0.7);
  EXPECT_NEAR(rig.to_camera(rig.to_projector(px, 0.5)).x, px.x - shift_px, 0.5);
}

TEST(Calibration, ItsProjectionAndHomographiesAgree) {
  const auto rig = rig_with_projector_beside();
  const glm::dvec3 point_m(0.05, -0.08, 0.55);
  const auto expected = rig.to_projector(rig.camera.project(point_m), point_m.z);
  const auto projected = rig.projection() * glm::dvec4(point_m, 1);
  EXPECT_LT(glm::distance(glm::dvec2(projected) / projected.z, expected), 1e-9);
  const auto mapped = rig.homography_at(point_m.z) * glm::dvec3(rig.camera.project(point_m), 1);
  EXPECT_LT(glm::distance(glm::dvec2(mapped) / mapped.z, expected), 1e-9);
}

TEST(Calibration, MillimetresPerPixelGrowWithTheDistance) {
  const auto rig = reference_rig();
  EXPECT_NEAR(rig.mm_per_projector_px(0.5), 500 / 1162.2776 * 720 / 1024, 1e-6);
  EXPECT_NEAR(rig.mm_per_projector_px(1.0), 2 * rig.mm_per_projector_px(0.5), 1e-12);
}

TEST(CalibrationFile, ReadsBackAsItWasPrinted) {
  auto rig = reference_rig();
  rig.camera.fx_px = 1000.0 / 3;
  rig.camera.width_px = 640;
  rig.projector_height_px = 800;
  const auto back = load_calibration(file_with(print_calibration(rig)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->camera.fx_px, rig.camera.fx_px);
  EXPECT_EQ(back->camera.k3, rig.camera.k3);
  EXPECT_EQ(back->camera.width_px, 640);
  EXPECT_EQ(back->projector_height_px, 800);
  EXPECT_LT(largest_difference(back->camera_from_tracker, rig.camera_from_tracker), 1e-15);
  EXPECT_EQ(back->projector_from_camera, rig.projector_from_camera);
}

TEST(CalibrationFile, AZeroHasNoSign) {
  auto rig = reference_rig();
  rig.camera.k1 = -0.0;
  rig.camera_from_tracker = glm::dmat4(-0.0);
  rig.parallax = glm::dvec3(-0.0);
  const auto text = print_calibration(rig);
  EXPECT_EQ(text.find("-0,"), std::string::npos) << text;
  EXPECT_EQ(text.find("-0]"), std::string::npos) << text;
}

TEST(CalibrationFile, KeepsTheNamesOfItsDevices) {
  auto rig = reference_rig();
  rig.camera_device = "23456789";
  rig.projector_device = "EPSON PJ";
  const auto back = load_calibration(file_with(print_calibration(rig)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->camera_device, "23456789");
  EXPECT_EQ(back->projector_device, "EPSON PJ");
}

TEST(CalibrationFile, KeepsTheProjectorsPlace) {
  const auto rig = rig_with_projector_beside();
  const auto back = load_calibration(file_with(print_calibration(rig)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->parallax, rig.parallax);
  EXPECT_EQ(back->plane_m, rig.plane_m);
}

TEST(CalibrationFile, SaysHowItWasMadeWithoutBecomingAnotherCalibration) {
  auto rig = reference_rig();
  rig.made.lens = "2026-11-24: 20 images";
  rig.made.pair = "2026-11-25: 15 views";
  const auto back = load_calibration(file_with(print_calibration(rig)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->made.lens, rig.made.lens);
  EXPECT_EQ(back->made.pair, rig.made.pair);
  EXPECT_EQ(back->id, load_calibration("")->id);
}

TEST(CalibrationFile, HasAnIdThatChangesWithAnyOfItsNumbers) {
  auto rig = reference_rig();
  const auto id = load_calibration(file_with(print_calibration(rig)))->id;
  EXPECT_NE(id, 0u);
  EXPECT_EQ(load_calibration("")->id, id) << "the file has the numbers of the reference rig";
  rig.camera.k1 += 1e-6;
  EXPECT_NE(load_calibration(file_with(print_calibration(rig)))->id, id);
}

TEST(CheckDevice, AnotherDeviceThanTheCalibratedIsRefused) {
  EXPECT_TRUE(check_device("camera", "", {"12"}));
  EXPECT_TRUE(check_device("camera", "cam", {"12", "cam"}));
  const auto other = check_device("camera", "11", {"12", "cam"});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::bad_config);
  EXPECT_THAT(other.error().what, HasSubstr("the camera '11', and this is '12'"));
}

TEST(CalibrationFile, NoFileIsTheReferenceRig) {
  const auto rig = load_calibration("");
  ASSERT_TRUE(rig);
  EXPECT_EQ(print_calibration(*rig), print_calibration(reference_rig()));
}

TEST(CalibrationFile, InTheTreeIsTheReferenceRigs) {
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto file =
      std::filesystem::path(source ? source : ".") / "config" / "calibrations" / "paper.toml";
  EXPECT_EQ(config::read_text(file).value(), print_calibration(reference_rig()));
}

TEST(CalibrationFile, ThatIsNotWholeIsRefusedWithWhatIsMissing) {
  const auto whole = print_calibration(reference_rig());
  const auto empty = load_calibration(file_with(""));
  ASSERT_FALSE(empty);
  EXPECT_THAT(empty.error().what, HasSubstr("camera.width_px, camera.height_px, camera.focal_px"));
  const auto cut = load_calibration(file_with(whole.substr(0, whole.find("[projector]"))));
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().what, HasSubstr("projector.x, projector.y, projector.w are missing"));
  const auto from = whole.find("# Rigid transform"), to = whole.find("# The projector.");
  EXPECT_TRUE(load_calibration(file_with(whole.substr(0, from) + whole.substr(to))))
      << "a rig without a tracker";
}

TEST(CalibrationFile, ThatIsFrozenStaysAsItWas) {
  const auto file = file_with(print_calibration(reference_rig()));
  const auto frozen = config::freeze(file.string());
  ASSERT_TRUE(frozen);
  EXPECT_EQ(config::freeze(*frozen), *frozen);
  EXPECT_EQ(config::freeze(""), "");
  auto changed = reference_rig();
  changed.camera.k1 = 0.01;
  file_with(print_calibration(changed));
  EXPECT_EQ(load_calibration(*frozen)->camera.k1, reference_rig().camera.k1);
  EXPECT_EQ(load_calibration(file)->camera.k1, 0.01);
  const auto broken = load_calibration(std::string(config::kFrozen) + "/a/b.toml\n[camera");
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().what, HasSubstr("/a/b.toml:1"));
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

TEST(CalibrationFile, IsNamedWhenItIsMissing) {
  const auto rig = load_calibration("/no/such/calibration.toml");
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("/no/such/calibration.toml"));
}

/// The reference rig with a second camera 0.3 m beside the first, turned by 0.4 rad.
Calibration two_cameras() {
  auto rig = reference_rig();
  SecondCamera second{"B-77", rig.camera, glm::dmat4(1)};
  second.camera.width_px = 640;
  second.from_camera[0] = {std::cos(0.4), 0, -std::sin(0.4), 0};
  second.from_camera[2] = {std::sin(0.4), 0, std::cos(0.4), 0};
  second.from_camera[3] = {-0.3, 0, 0.01, 1};
  rig.camera2 = second;
  return rig;
}

TEST(SecondCamera, IsReadBackAsItWasPrinted) {
  const auto read = load_calibration(file_with(print_calibration(two_cameras())));
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_TRUE(read->camera2);
  EXPECT_EQ(read->camera2->device, "B-77");
  EXPECT_EQ(read->camera2->camera.width_px, 640);
  EXPECT_LT(largest_difference(read->camera2->from_camera, two_cameras().camera2->from_camera),
            1e-9);
}

TEST(SecondCamera, IsAPartOfTheId) {
  const auto one = load_calibration(file_with(print_calibration(reference_rig())));
  auto moved = two_cameras();
  const auto two = load_calibration(file_with(print_calibration(moved)));
  moved.camera2->from_camera[3].x = -0.31;
  const auto other = load_calibration(file_with(print_calibration(moved)));
  ASSERT_TRUE(one && two && other);
  EXPECT_NE(one->id, two->id);
  EXPECT_NE(two->id, other->id);
  EXPECT_FALSE(one->camera2);
}

TEST(SecondCamera, IsRefusedIfItCannotBe) {
  const auto refusal = [](const Calibration& calibration) {
    const auto read = load_calibration(file_with(print_calibration(calibration)));
    return read ? std::string() : read.error().what;
  };
  auto rig = two_cameras();
  rig.camera2->from_camera[3] = {0.001, 0, 0, 1};
  EXPECT_THAT(refusal(rig), HasSubstr("see no depth"));
  rig.camera2->from_camera[3] = {-300, 0, 0, 1};
  EXPECT_THAT(refusal(rig), HasSubstr("camera2_from_camera: the second camera is 300 m away"));
  rig = two_cameras();
  rig.camera2->from_camera[0][0] = 2;
  EXPECT_THAT(refusal(rig), HasSubstr("camera2_from_camera: its first three columns"));
  rig = two_cameras();
  rig.camera2->camera.fx_px = 5;
  EXPECT_THAT(refusal(rig), HasSubstr("camera2.focal_px"));
  rig = two_cameras();
  rig.camera2->from_camera[0] = {-1, 0, 0, 0};
  rig.camera2->from_camera[2] = {0, 0, -1, 0};
  EXPECT_THAT(refusal(rig), HasSubstr("camera2_from_camera: the second camera looks away"));
  EXPECT_EQ(refusal(two_cameras()), "");
  const auto half = load_calibration(
      file_with(print_calibration(reference_rig()) + "[camera2]\nwidth_px = 720\n"));
  ASSERT_FALSE(half);
  EXPECT_THAT(half.error().what, HasSubstr("camera2_from_camera.x"));
}

TEST(SecondView, IsTheSameRigFromTheOtherCamera) {
  const auto rig = two_cameras();
  const auto second = second_view(rig);
  EXPECT_EQ(second.camera.width_px, 640);
  EXPECT_EQ(second.camera_device, "B-77");
  const glm::dvec4 in_tracker(0.1, 0.2, 0.3, 1);
  const auto first_m = rig.camera_from_tracker * in_tracker;
  EXPECT_LT(
      glm::distance(second.camera_from_tracker * in_tracker, rig.camera2->from_camera * first_m),
      1e-12);
  const auto back = first_view(second);
  EXPECT_EQ(back.camera.width_px, rig.camera.width_px);
  EXPECT_LT(largest_difference(back.camera_from_tracker, rig.camera_from_tracker), 1e-12);
  EXPECT_LT(largest_difference(back.camera2->from_camera, rig.camera2->from_camera), 1e-12);
  EXPECT_FALSE(back.is_second_view);
}

}  // namespace
}  // namespace handcast::calib
