// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "services/evaluation/twin/held_board.hpp"
#include "tests/services/evaluation/twin/world.hpp"

/// The camera's images of a board that is held, and of the projector's light on it.
namespace handcast::twin {
namespace {

using renderer::Image;

constexpr int kColumns = 10, kRows = 7;
constexpr double kSquare_m = 0.025;

/// A checkerboard with a margin of half a square. Its origin is the corner of the first four
/// squares.
FlatPicture checkerboard(int px_per_square) {
  FlatPicture picture;
  picture.width_px = (kColumns + 1) * px_per_square;
  picture.height_px = (kRows + 1) * px_per_square;
  picture.metres_per_px = kSquare_m / px_per_square;
  picture.origin_px = glm::dvec2(1.5 * px_per_square - 0.5);
  for (int y = 0; y < picture.height_px; ++y)
    for (int x = 0; x < picture.width_px; ++x) {
      const int column = (2 * x / px_per_square + 1) / 2 - 1,
                row = (2 * y / px_per_square + 1) / 2 - 1;
      const bool margin = column < 0 || row < 0 || column >= kColumns || row >= kRows;
      picture.pixels.push_back(!margin && (column + row) % 2 == 0 ? 15 : 240);
    }
  return picture;
}

/// White paper of the same size and place.
FlatPicture blank() {
  auto picture = checkerboard(10);
  std::fill(picture.pixels.begin(), picture.pixels.end(), std::uint8_t{255});
  return picture;
}

config::Rig board_rig(double leak = 0) {
  auto rig = rig_with("builtin:open_close");
  rig.twin.prop.kind = config::TwinPropKind::board;
  rig.twin.image.noise = 0;
  rig.twin.image.leak = leak;
  return rig;
}

std::unique_ptr<Twin> twin_with(const config::Rig& rig, const FlatPicture& picture) {
  auto twin = twin_of(rig);
  const auto shown = twin->show_board(picture);
  EXPECT_TRUE(shown) << shown.error().what;
  return twin;
}

/// The camera frame in the middle of the hold at a place.
std::uint64_t frame_at(const config::Rig& rig, int place) {
  const double seconds =
      place * (rig.twin.prop.hold_s + HeldBoard::kMove_s) + rig.twin.prop.hold_s / 2;
  return static_cast<std::uint64_t>(seconds * rig.camera.rate_hz);
}

Image<std::uint8_t> shot(const Twin& twin, std::uint64_t k) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, image.view());
  return image;
}

/// The grey levels of a projector image.
struct Picture {
  std::vector<std::uint8_t> grey = std::vector<std::uint8_t>(1024 * 768);
  Light light() const { return {grey.data(), 1024, 768}; }
};

/// A bright square around a projector pixel.
Picture spot(int x_px, int y_px, int reach_px) {
  Picture picture;
  for (int y = y_px - reach_px; y <= y_px + reach_px; ++y)
    for (int x = x_px - reach_px; x <= x_px + reach_px; ++x) picture.grey[y * 1024 + x] = 255;
  return picture;
}

Image<std::uint8_t> lit_shot(const Twin& twin, std::uint64_t k, const Picture& picture) {
  Image<std::uint8_t> image(720, 540);
  twin.camera_image(k, picture.light(), image.view());
  return image;
}

glm::dvec3 ray_of(const Twin& twin, const glm::dvec2& image_px) {
  const auto& camera = twin.geometry().calibration().camera;
  return glm::inverse(camera.matrix()) * glm::dvec3(camera.undistort(image_px), 1);
}

/// The point of the board that a pixel of the true camera sees, camera space.
glm::dvec3 on_board_m(const Twin& twin, const glm::dmat4& pose, const glm::dvec2& image_px) {
  const auto ray = ray_of(twin, image_px);
  return ray *
         (glm::dot(glm::dvec3(pose[2]), glm::dvec3(pose[3])) / glm::dot(glm::dvec3(pose[2]), ray));
}

/// Where a place on the board is in the image.
glm::dvec2 in_image_px(const Twin& twin, std::uint64_t k, const glm::dvec2& board_m) {
  const auto& camera = twin.geometry().calibration().camera;
  const auto pose = *twin.board_pose(twin.camera_origin_ns(k));
  return camera.distort(camera.project(glm::dvec3(pose * glm::dvec4(board_m, 0, 1))));
}

/// The mean position of what light adds to an image; NaN if it adds nothing.
glm::dvec2 centre_of_light(const Image<std::uint8_t>& lit, const Image<std::uint8_t>& dark) {
  glm::dvec2 sum(0);
  double weight = 0;
  for (int y = 0; y < lit.height(); ++y)
    for (int x = 0; x < lit.width(); ++x) {
      const double more = lit.at(x, y) - dark.at(x, y);
      sum += more * glm::dvec2(x, y);
      weight += more;
    }
  return sum / weight;
}

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

TEST(Board, ASpotOfLightIsWhereTheProjectorSendsIt) {
  auto rig = board_rig(0.3);
  rig.twin.geometry.projector_offset_mm = 60;
  rig.twin.geometry.homography_px = 5;
  const auto twin = twin_with(rig, blank());
  double most_px = 0;
  for (int place = 0; place < HeldBoard::kPlaces; place += 3) {
    const auto k = frame_at(rig, place);
    const auto pose = *twin->board_pose(twin->camera_origin_ns(k));
    const glm::dvec3 middle(pose * glm::dvec4(0.1, 0.07, 0, 1));
    const glm::ivec2 lamp_px(glm::round(twin->geometry().to_projector(middle)));
    const auto seen_px =
        centre_of_light(lit_shot(*twin, k, spot(lamp_px.x, lamp_px.y, 4)), shot(*twin, k));
    const auto from_px = twin->geometry().to_projector(on_board_m(*twin, pose, seen_px));
    most_px = std::max(most_px, glm::distance(from_px, glm::dvec2(lamp_px)));
  }
  std::printf("spots: largest error %.3f projector px\n", most_px);
  EXPECT_LT(most_px, 0.3);
}

TEST(Board, LightBesideItIsOnTheTableOneMetreAway) {
  auto rig = board_rig(1);
  rig.twin.geometry.projector_offset_mm = 60;
  rig.twin.image.background = 60;
  auto small = blank();
  small.metres_per_px /= 20;
  const auto twin = twin_with(rig, small);
  const auto dark = shot(*twin, 0);
  int spots = 0;
  for (const glm::dvec2 px : {glm::dvec2(100, 100), {620, 100}, {100, 440}, {620, 440}}) {
    if (glm::distance(px, in_image_px(*twin, 0, {0, 0})) < 60) continue;
    const glm::ivec2 lamp_px(glm::round(twin->geometry().to_projector(ray_of(*twin, px))));
    const auto seen_px = centre_of_light(lit_shot(*twin, 0, spot(lamp_px.x, lamp_px.y, 6)), dark);
    const auto from_px = twin->geometry().to_projector(ray_of(*twin, seen_px));
    EXPECT_LT(glm::distance(from_px, glm::dvec2(lamp_px)), 0.3);
    EXPECT_NEAR(lit_shot(*twin, 0, spot(lamp_px.x, lamp_px.y, 6)).at(int(px.x), int(px.y)),
                2 * dark.at(int(px.x), int(px.y)), 2)
        << "as bright as the lamp's light";
    ++spots;
  }
  EXPECT_GE(spots, 3);
}

TEST(Board, AFilterThatLeaksNothingHidesTheProjector) {
  const auto rig = board_rig(0);
  const auto twin = twin_with(rig, blank());
  const auto k = frame_at(rig, 0);
  EXPECT_EQ(lit_shot(*twin, k, spot(512, 384, 200)).pixels(), shot(*twin, k).pixels());
}

TEST(Board, ADarkProjectorIsNoProjector) {
  auto rig = board_rig(0.5);
  rig.twin.image.spread_px = 1.5;
  rig.twin.image.sunlight = 0.1;
  const auto twin = twin_with(rig, checkerboard(40));
  for (const int place : {0, 4, 8}) {
    const auto k = frame_at(rig, place);
    const auto lit = lit_shot(*twin, k, Picture()), dark = shot(*twin, k);
    for (std::size_t i = 0; i < lit.pixels().size(); ++i)
      ASSERT_NEAR(lit.pixels()[i], dark.pixels()[i], 1) << "place " << place << ", pixel " << i;
  }
}

TEST(Board, LightThatIsHalfAsStrongAddsHalfAsMuch) {
  const auto rig = board_rig(0.4);
  const auto twin = twin_with(rig, blank());
  const auto k = frame_at(rig, 5);
  const auto px = glm::ivec2(glm::round(in_image_px(*twin, k, {0.1, 0.07})));
  Picture full, half;
  std::fill(full.grey.begin(), full.grey.end(), std::uint8_t{255});
  std::fill(half.grey.begin(), half.grey.end(), std::uint8_t{128});
  const double dark = shot(*twin, k).at(px.x, px.y);
  EXPECT_NEAR(lit_shot(*twin, k, full).at(px.x, px.y), 1.4 * dark, 2);
  EXPECT_NEAR(lit_shot(*twin, k, half).at(px.x, px.y), 1.2 * dark, 2);
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

TEST(Board, HandsTakeNoNoticeOfTheProjectorsLight) {
  const auto rig = rig_with("builtin:still");
  const auto twin = twin_of(rig);
  EXPECT_EQ(lit_shot(*twin, 3, spot(512, 384, 200)).pixels(), shot(*twin, 3).pixels());
  EXPECT_FALSE(twin->board_pose(0));
}

TEST(Board, DrawingTime) {
  const auto rig = board_rig(0.3);
  const auto twin = twin_with(rig, checkerboard(100));
  const auto ms_per_frame = [&](auto&& draw) {
    const std::clock_t begin = std::clock();
    for (int place = 0; place < HeldBoard::kPlaces; ++place) draw(frame_at(rig, place));
    return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / HeldBoard::kPlaces;
  };
  Image<std::uint8_t> image(720, 540);
  const auto light = spot(512, 384, 200);
  const double dark_ms = ms_per_frame([&](auto k) { twin->camera_image(k, image.view()); });
  const double lit_ms =
      ms_per_frame([&](auto k) { twin->camera_image(k, light.light(), image.view()); });
  std::printf("a frame with a board: %.2f ms, with the projector's light %.2f ms\n", dark_ms,
              lit_ms);
}

}  // namespace
}  // namespace handcast::twin
