// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tests/scratch.hpp"
#include "tests/services/lab/twin/board_world.hpp"

/// The camera's images of a board that is held.
namespace handcast::twin {
namespace {

/// Distances between the true inner corners of the checkerboard and those that are found in the
/// image, as far as they are inside.
std::vector<double> corner_errors_px(const Twin& twin, std::uint64_t k, Image<std::uint8_t> image) {
  std::vector<cv::Point2f> truth;
  for (int row = 0; row + 1 < kRows; ++row)
    for (int column = 0; column + 1 < kColumns; ++column) {
      const auto px = in_image_px(twin, k, kSquare_m * glm::dvec2(column, row));
      if (px.x > 10 && px.y > 10 && px.x < 709 && px.y < 529) truth.emplace_back(px.x, px.y);
    }
  auto found = truth;
  for (auto& px : found) px += cv::Point2f(0.7f, -0.6f);
  const cv::Mat grey(image.height(), image.width(), CV_8U, image.pixels().data());
  cv::cornerSubPix(grey, found, {4, 4}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-3});
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) errors.push_back(cv::norm(found[i] - truth[i]));
  return errors;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(Board, ItsCornersAreWhereTheTruthPutsThem) {
  auto rig = board_rig();
  rig.twin.image.noise = 2;
  rig.twin.geometry.lens_px = 6;
  const auto twin = twin_with(rig, checkerboard(100));
  std::vector<double> all;
  for (int place = 0; place < HeldBoard::kPlaces; ++place) {
    const auto k = frame_at(rig, place);
    const auto errors = corner_errors_px(*twin, k, shot(*twin, k));
    EXPECT_GT(errors.size(), 30u) << "place " << place;
    EXPECT_LT(mean_of(errors), 0.12) << "place " << place;
    all.insert(all.end(), errors.begin(), errors.end());
  }
  std::printf("corners: mean error %.3f px, largest %.3f px\n", mean_of(all),
              *std::max_element(all.begin(), all.end()));
  EXPECT_LT(mean_of(all), 0.08);
  EXPECT_LT(*std::max_element(all.begin(), all.end()), 0.4);
}

/// The calibration of two cameras that look at one place, with different lenses.
calib::Calibration two_cameras() {
  auto rig = calib::reference_rig();
  auto lens = rig.camera;
  lens.fx_px = lens.fy_px = 1100;
  const auto turn = glm::rotate(glm::dmat4(1), std::atan2(0.3, 0.73), {0, 1, 0});
  rig.camera2 = calib::SecondCamera{{}, lens, glm::translate(turn, {-0.3, 0, 0})};
  return rig;
}

TEST(Board, ASecondCameraSeesTheSameBoardFromItsOwnPlace) {
  auto rig = board_rig();
  rig.twin.image.noise = 2;
  rig.twin.prop.views = config::TwinPropViews::both;
  const auto cameras = two_cameras();
  auto first = Twin::create(rig, cameras).value(),
       second = Twin::create(rig, cameras, config::Viewpoint::second).value();
  ASSERT_TRUE(first->show_board(checkerboard(100)));
  ASSERT_TRUE(second->show_board(checkerboard(100)));
  for (int place = 0; place < HeldBoard::kPlaces; place += 4) {
    const auto k = frame_at(rig, place);
    const auto time_ns = first->camera_origin_ns(k);
    const auto there = *second->board_pose(time_ns);
    const auto off = there - cameras.camera2->from_camera * *first->board_pose(time_ns);
    for (int column = 0; column < 4; ++column) EXPECT_LT(glm::length(off[column]), 1e-12);
    std::vector<cv::Point2f> truth;
    for (int row = 0; row + 1 < kRows; ++row)
      for (int column = 0; column + 1 < kColumns; ++column) {
        const glm::dvec4 corner_m(kSquare_m * glm::dvec2(column, row), 0, 1);
        const auto& lens = cameras.camera2->camera;
        const auto px = lens.distort(lens.project(glm::dvec3(there * corner_m)));
        if (px.x > 10 && px.y > 10 && px.x < 709 && px.y < 529) truth.emplace_back(px.x, px.y);
      }
    EXPECT_GT(truth.size(), 38u) << "the second camera sees most of it, place " << place;
    auto found = truth;
    for (auto& px : found) px += cv::Point2f(0.7f, -0.6f);
    auto image = shot(*second, k);
    cv::cornerSubPix(cv::Mat(image.height(), image.width(), CV_8U, image.pixels().data()), found,
                     {4, 4}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-3});
    double sum_px = 0;
    for (std::size_t i = 0; i < found.size(); ++i) sum_px += cv::norm(found[i] - truth[i]);
    EXPECT_LT(sum_px / static_cast<double>(found.size()), 0.12) << "place " << place;
  }
}

TEST(Board, ItIsMovedThroughTheImageOfTheCameraThatIsNamed) {
  auto rig = board_rig();
  rig.twin.prop.views = config::TwinPropViews::second;
  const auto cameras = two_cameras();
  auto second = Twin::create(rig, cameras, config::Viewpoint::second).value();
  ASSERT_TRUE(second->show_board(checkerboard(20)));
  double leftmost = 720, rightmost = 0;
  for (int place = 0; place < HeldBoard::kPlaces; ++place) {
    const auto pose = *second->board_pose(second->camera_origin_ns(frame_at(rig, place)));
    const auto px = cameras.camera2->camera.project(glm::dvec3(pose * glm::dvec4(0.1, 0.07, 0, 1)));
    leftmost = std::min(leftmost, px.x);
    rightmost = std::max(rightmost, px.x);
  }
  EXPECT_LT(leftmost, 240);
  EXPECT_GT(rightmost, 480);
  auto alone = twin_of(rig);
  const auto shown = alone->show_board(checkerboard(20));
  ASSERT_FALSE(shown);
  EXPECT_THAT(shown.error().what, testing::HasSubstr("the rig has one camera"));
}

TEST(Board, TheTrueSecondCameraIsThatOfTheTrueRig) {
  auto rig = board_rig();
  const test::Scratch scratch;
  const auto truth = two_cameras();
  rig.twin.geometry.calibration = scratch.path() / "truth.toml";
  std::ofstream(rig.twin.geometry.calibration) << calib::print_calibration(truth);
  auto believed = truth;
  believed.camera2->from_camera[3].x += 0.02;
  auto first = Twin::create(rig, believed).value(),
       second = Twin::create(rig, believed, config::Viewpoint::second).value();
  ASSERT_TRUE(first->show_board(checkerboard(20)));
  ASSERT_TRUE(second->show_board(checkerboard(20)));
  const auto off = *second->board_pose(0) - truth.camera2->from_camera * *first->board_pose(0);
  EXPECT_LT(glm::length(off[3]), 1e-9);
}

TEST(Board, TheResolutionOfItsPictureDoesNotMatter) {
  const auto rig = board_rig();
  for (const int px_per_square : {10, 34, 250}) {
    const auto twin = twin_with(rig, checkerboard(px_per_square));
    const auto k = frame_at(rig, 3);
    EXPECT_LT(mean_of(corner_errors_px(*twin, k, shot(*twin, k))), 0.08) << px_per_square;
  }
}

TEST(Board, WhitePaperIsAsBrightAsTheLampAtTheLensMakesIt) {
  const auto rig = board_rig();
  const auto twin = twin_with(rig, blank());
  for (int place = 0; place < HeldBoard::kPlaces; ++place) {
    const auto k = frame_at(rig, place);
    const auto px = glm::round(in_image_px(*twin, k, {0.1, 0.07}));
    const auto pose = *twin->board_pose(twin->camera_origin_ns(k));
    const auto point = on_board_m(*twin, pose, px);
    const double distance = glm::length(point);
    const double cosine = glm::dot(glm::dvec3(pose[2]), point) / distance;
    const double from_middle =
        glm::length(px - glm::dvec2(360, 270)) / glm::length(glm::dvec2(360, 270));
    const double expected = 0.75 * 190 * (0.4 + 0.6 * cosine) * std::pow(0.73 / distance, 2) *
                            (1 - 0.3 * from_middle * from_middle);
    EXPECT_NEAR(shot(*twin, k).at(int(px.x), int(px.y)), expected, 1.01) << "place " << place;
    EXPECT_LT(expected, 255);
  }
}

TEST(Board, BesideItTheSceneIsEmpty) {
  const auto rig = board_rig();
  const auto twin = twin_with(rig, blank());
  const auto empty = shot(*twin_of(rig), 0);
  int board = 0, different = 0;
  const auto k = frame_at(rig, 2);
  const auto image = shot(*twin, k);
  const auto pose = *twin->board_pose(twin->camera_origin_ns(k));
  const auto inverse = glm::inverse(pose);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x) {
      const glm::dvec2 at(inverse * glm::dvec4(on_board_m(*twin, pose, {x, y}), 1));
      const auto beyond =
          glm::abs(at - kSquare_m * glm::dvec2(4, 2.5)) - kSquare_m * glm::dvec2(5.5, 4);
      const double outside_m = std::max(beyond.x, beyond.y);
      if (outside_m < -0.001) board += image.at(x, y) > 60;
      if (outside_m < -0.001) different += image.at(x, y) <= 60;
      if (outside_m > 0.001) different += image.at(x, y) != empty.at(x, y);
    }
  EXPECT_GT(board, 20'000);
  EXPECT_EQ(different, 0);
}

TEST(Board, TheExposureBlursItWhileItMoves) {
  auto rig = board_rig();
  rig.camera.exposure_ms = 20;
  rig.camera.rate_hz = 40;
  rig.twin.image.blur_samples = 16;
  /// The steepest step between neighbours in the image.
  const auto steepest = [&](double seconds) {
    const auto twin = twin_with(rig, checkerboard(40));
    const auto image = shot(*twin, static_cast<std::uint64_t>(seconds * rig.camera.rate_hz));
    std::vector<int> steps;
    for (int y = 0; y < 540; ++y)
      for (int x = 1; x < 720; ++x) steps.push_back(std::abs(image.at(x, y) - image.at(x - 1, y)));
    std::sort(steps.begin(), steps.end());
    return steps[steps.size() - 1000];
  };
  const double held_s = rig.twin.prop.hold_s / 2,
               moving_s = rig.twin.prop.hold_s + HeldBoard::kMove_s / 2;
  EXPECT_LT(steepest(moving_s), 0.7 * steepest(held_s));
}

TEST(Board, IsTheSameInEveryTwinOfASeed) {
  auto rig = board_rig(0.2);
  rig.twin.image.noise = 2;
  const auto k = frame_at(rig, 1);
  const auto image = [&] {
    return lit_shot(*twin_with(rig, checkerboard(40)), k, spot(500, 400, 50)).pixels();
  };
  const auto first = image();
  EXPECT_EQ(first, image());
  rig.twin.seed = 2;
  EXPECT_NE(first, image());
}

TEST(Board, ReplacesTheHandsForAllSensors) {
  const auto rig = board_rig();
  const auto twin = twin_with(rig, checkerboard(40));
  EXPECT_FALSE(twin->joints(Side::left, 0));
  EXPECT_FALSE(twin->landmarks(Side::left, 0));
  EXPECT_EQ(twin->tracker_sample(5).poses.count, 0u);
  EXPECT_EQ(twin->detect(1, 5, twin->camera_stamp_ns(5)).landmarks.count, 0u);
}

TEST(Board, WithoutAPictureTheSceneIsEmpty) {
  const auto twin = twin_of(board_rig());
  EXPECT_FALSE(twin->board_pose(0));
  const auto image = shot(*twin, 0);
  EXPECT_LT(*std::max_element(image.pixels().begin(), image.pixels().end()), 12);
}

TEST(Board, AnUnusablePictureIsRefusedWithASentence) {
  const auto twin = twin_of(board_rig());
  const auto refused = [&](auto&& spoil) {
    auto picture = checkerboard(10);
    spoil(picture);
    const auto shown = twin->show_board(picture);
    return shown ? "accepted" : shown.error().what;
  };
  using testing::HasSubstr;
  EXPECT_THAT(refused([](auto& p) { p = {}; }), HasSubstr("0 x 0 pixels, but has 0"));
  EXPECT_THAT(refused([](auto& p) { p.pixels.pop_back(); }), HasSubstr("but has 8799"));
  EXPECT_THAT(refused([](auto& p) { p.metres_per_px = 0; }), HasSubstr("0 m per pixel"));
  EXPECT_THAT(refused([](auto& p) { p.origin_px.x = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("origin at (nan"));
  EXPECT_FALSE(twin->board_pose(0)) << "a refused picture changes nothing";

  const auto with_hands = twin_of(rig_with("builtin:still"))->show_board(checkerboard(10));
  ASSERT_FALSE(with_hands);
  EXPECT_EQ(with_hands.error().code, Errc::bad_config);
  EXPECT_THAT(with_hands.error().what, HasSubstr("twin.prop.kind"));
}

}  // namespace
}  // namespace handcast::twin
