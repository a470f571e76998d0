// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <glm/gtc/type_ptr.hpp>

#include "config/settings/files.hpp"
#include "config/settings/frozen_file.hpp"
#include "tests/calib/calibration_files.hpp"

namespace handcast::calib {
namespace {

using ::testing::HasSubstr;

TEST(Calibration, ToCameraIsTheInverseOfToProjector) {
  const auto rig = reference_rig();
  for (double x : {0.0, 300.5, 1023.0})
    for (double y : {0.0, 200.25, 767.0})
      EXPECT_LT(
          glm::distance(rig.projector.pixel_of(rig.projector.camera_pixel_of({x, y})), {x, y}),
          1e-9);
}

Calibration rig_with_projector_beside() {
  auto rig = reference_rig();
  rig.projector.plane_m = 0.7;
  rig.projector.parallax =
      -(rig.projector.from_camera * (rig.camera.matrix() * glm::dvec3(0.15, 0.02, 0)));
  return rig;
}

TEST(Calibration, ACoaxialProjectorLightsAPixelAtEveryDepth) {
  const auto rig = reference_rig();
  EXPECT_EQ(rig.projector.pixel_of({200, 300}, 0.4), rig.projector.pixel_of({200, 300}));
}

TEST(Calibration, AProjectorBesideTheCameraHasTheParallaxOfItsPlace) {
  const auto rig = rig_with_projector_beside();
  const glm::dvec2 px(200, 300);
  EXPECT_LT(
      glm::distance(rig.projector.pixel_of(px, rig.projector.plane_m), rig.projector.pixel_of(px)),
      1e-9);
  // Seen from 0.15 m further to the right, a point that is nearer than the plane lies to the left:
  // by 0.15 m times the focal length times the difference of the inverse depths.
  const double shift_px = 0.15 * rig.camera.fx_px * (1 / 0.5 - 1 / 0.7);
  EXPECT_NEAR(rig.projector.camera_pixel_of(rig.projector.pixel_of(px, 0.5)).x, px.x - shift_px,
              0.5);
}

TEST(Calibration, ItsProjectionAndHomographiesAgree) {
  const auto rig = rig_with_projector_beside();
  const glm::dvec3 point_m(0.05, -0.08, 0.55);
  const auto expected = rig.projector.pixel_of(rig.camera.project(point_m), point_m.z);
  const auto projected = rig.projection() * glm::dvec4(point_m, 1);
  EXPECT_LT(glm::distance(glm::dvec2(projected) / projected.z, expected), 1e-9);
  const auto mapped =
      rig.projector.homography_at(point_m.z) * glm::dvec3(rig.camera.project(point_m), 1);
  EXPECT_LT(glm::distance(glm::dvec2(mapped) / mapped.z, expected), 1e-9);
}

TEST(Calibration, ItsProjectionHasTheDistanceAlongTheProjectorsAxis) {
  auto rig = rig_with_projector_beside();
  // A projector 0.15 m to the right that looks as the camera does is as far from everything.
  rig.projector.from_camera[0].z = rig.projector.from_camera[1].z = 0;
  rig.projector.from_camera[2].z = 1;
  rig.projector.parallax.z = 0;
  for (const double scale : {1.0, -3.0}) {
    auto other = rig;
    other.projector.from_camera *= scale;
    other.projector.parallax *= scale;
    EXPECT_NEAR((other.projection() * glm::dvec4(0.05, -0.08, 0.55, 1)).z, 0.55, 1e-9);
  }
}

TEST(Calibration, TheProjectorIsSeenAtAnAngleToTheCamera) {
  EXPECT_NEAR(reference_rig().degrees_apart(), 0, 1e-3);
  EXPECT_NEAR(rig_with_projector_beside().degrees_apart(), 12.2, 0.1);
  EXPECT_NEAR(load_calibration("config/calibrations/left_of_two.toml")->degrees_apart(), 30, 0.5);
}

TEST(Calibration, EachOfTwoProjectorsHasItsOwnFirst) {
  auto rig = reference_rig();
  rig.projector_device = "left";
  rig.projector2 = SecondProjector{"right", rig_with_projector_beside().projector};
  EXPECT_EQ(at_projector(rig, config::Viewpoint::first).projector_device, "left");
  const auto second = at_projector(rig, config::Viewpoint::second);
  EXPECT_EQ(second.projector_device, "right");
  EXPECT_EQ(second.projector.parallax, rig.projector2->model.parallax);
  EXPECT_EQ(second.projector2->model.parallax, glm::dvec3(0));
  EXPECT_EQ(second.id, rig.id) << "they see the same images";
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
  rig.projector.height_px = 800;
  const auto back = load_calibration(file_with(print_calibration(rig)));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->camera.fx_px, rig.camera.fx_px);
  EXPECT_EQ(back->camera.k3, rig.camera.k3);
  EXPECT_EQ(back->camera.width_px, 640);
  EXPECT_EQ(back->projector.height_px, 800);
  EXPECT_LT(largest_difference(back->camera_from_tracker, rig.camera_from_tracker), 1e-15);
  EXPECT_EQ(back->projector.from_camera, rig.projector.from_camera);
}

TEST(CalibrationFile, AZeroHasNoSign) {
  auto rig = reference_rig();
  rig.camera.k1 = -0.0;
  rig.camera_from_tracker = glm::dmat4(-0.0);
  rig.projector.parallax = glm::dvec3(-0.0);
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
  EXPECT_EQ(back->projector.parallax, rig.projector.parallax);
  EXPECT_EQ(back->projector.plane_m, rig.projector.plane_m);
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

TEST(PlacedCamera, TheSecondOneHasItsOwnLensAndPlace) {
  using config::Viewpoint;
  const auto rig = two_cameras();
  const auto first = camera_at(rig, Viewpoint::first).value(),
             second = camera_at(rig, Viewpoint::second).value();
  EXPECT_EQ(first.model.width_px, rig.camera.width_px);
  EXPECT_EQ(first.from_tracker, rig.camera_from_tracker);
  EXPECT_EQ(second.model.width_px, 640);
  EXPECT_EQ(second.device, "B-77");
  const glm::dvec4 in_tracker(0.1, 0.2, 0.3, 1);
  EXPECT_LT(glm::distance(second.from_tracker * in_tracker,
                          rig.camera2->from_camera * (first.from_tracker * in_tracker)),
            1e-12);
  const auto none = camera_at(reference_rig(), Viewpoint::second);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::bad_config);
}

}  // namespace
}  // namespace handcast::calib
