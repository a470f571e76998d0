// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/held_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

/// Where a person holds a board, as the camera sees it.
namespace handcast::twin {
namespace {

constexpr double kHold_s = 2, kPeriod_s = kHold_s + HeldBoard::kMove_s;
const BoardOutline kBoard{{-0.03, -0.03}, {0.22, 0.15}};

double middle_s(int place) { return place * kPeriod_s + kHold_s / 2; }

/// Grid points of the board in the image as the lens forms it, at one time.
std::vector<glm::dvec2> in_image(const HeldBoard& held, const BoardOutline& board,
                                 const calib::CameraModel& camera, double seconds) {
  constexpr int kSteps = 17;
  const auto pose = held.camera_from_board(seconds);
  std::vector<glm::dvec2> points;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const auto place =
          glm::mix(board.from_m, board.to_m, (glm::dvec2(i, j) + 0.5) / double(kSteps));
      points.push_back(camera.distort(camera.project(glm::dvec3(pose * glm::dvec4(place, 0, 1)))));
    }
  return points;
}

/// The share of the board in the image: of the worst place, and the mean over all.
struct Shares {
  double least = 1, mean = 0;
};
Shares shares_inside(const calib::CameraModel& camera, const BoardOutline& board, int seed) {
  const HeldBoard held(camera, board, seed, kHold_s);
  Shares shares;
  for (int i = 0; i < HeldBoard::kPlaces; ++i) {
    const auto points = in_image(held, board, camera, middle_s(i));
    const auto count = std::count_if(points.begin(), points.end(),
                                     [&](const auto& px) { return camera.contains(px); });
    const double share = static_cast<double>(count) / static_cast<double>(points.size());
    shares.least = std::min(shares.least, share);
    shares.mean += share / HeldBoard::kPlaces;
  }
  return shares;
}

HeldBoard usual(int seed = 1) { return {calib::reference_rig().camera, kBoard, seed, kHold_s}; }

TEST(HeldBoard, ReachesAllNineCellsOfTheImageAndItsCorners) {
  const auto camera = calib::reference_rig().camera;
  for (int seed = 1; seed <= 5; ++seed) {
    std::array<int, 9> places_in{};
    std::array<double, 4> corner_px;
    corner_px.fill(1e9);
    for (int i = 0; i < HeldBoard::kPlaces; ++i) {
      std::set<int> cells;
      for (const auto& px : in_image(usual(seed), kBoard, camera, middle_s(i))) {
        if (camera.contains(px)) cells.insert(int(px.x) / 240 + 3 * (int(px.y) / 180));
        for (int c = 0; c < 4; ++c)
          corner_px[c] = std::min(corner_px[c], glm::distance(px, {c % 2 * 719, c / 2 * 539}));
      }
      for (const int cell : cells) ++places_in[cell];
    }
    EXPECT_GE(*std::min_element(places_in.begin(), places_in.end()), 6) << "seed " << seed;
    EXPECT_LT(*std::max_element(corner_px.begin(), corner_px.end()), 40) << "seed " << seed;
  }
}

TEST(HeldBoard, TiltsInAllDirectionsAndFacesTheCameraInSomePlaces) {
  std::set<int> eighths;
  int flat = 0, steep = 0;
  double nearest_m = 9, farthest_m = 0;
  const auto held = usual();
  for (int i = 0; i < HeldBoard::kPlaces; ++i) {
    const auto pose = held.camera_from_board(middle_s(i));
    const glm::dvec3 into = glm::dvec3(pose[2]);
    const double tilt_deg = glm::degrees(std::acos(std::min(1.0, into.z)));
    EXPECT_LT(tilt_deg, 40.001);
    EXPECT_NEAR(glm::determinant(glm::dmat3(pose)), 1, 1e-9);
    flat += tilt_deg < 2.5;
    steep += tilt_deg > 30;
    if (tilt_deg > 10) eighths.insert(int(std::floor((std::atan2(into.y, into.x) / M_PI + 1) * 4)));
    const double z_m = (pose * glm::dvec4((kBoard.from_m + kBoard.to_m) / 2.0, 0, 1)).z;
    nearest_m = std::min(nearest_m, z_m);
    farthest_m = std::max(farthest_m, z_m);
  }
  EXPECT_GE(flat, 5);
  EXPECT_GE(steep, 5);
  EXPECT_GE(eighths.size(), 7u);
  EXPECT_NEAR(nearest_m, 0.55, 0.03);
  EXPECT_NEAR(farthest_m, 0.95, 0.03);
}

TEST(HeldBoard, IsStillExceptForAHandsTremorWhileItIsHeld) {
  const auto held = usual();
  for (const int place : {0, 7, 29}) {
    const double begin_s = place * kPeriod_s;
    glm::dvec3 mean(0);
    double square = 0;
    constexpr int kCount = 400;
    const auto at = [&](int i) {
      return glm::dvec3(held.camera_from_board(begin_s + kHold_s * i / kCount)[3]);
    };
    for (int i = 0; i < kCount; ++i) mean += at(i) / double(kCount);
    for (int i = 0; i < kCount; ++i) square += glm::dot(at(i) - mean, at(i) - mean) / kCount;
    const double rms_mm = 1e3 * std::sqrt(square);
    EXPECT_GT(rms_mm, 0.1);
    EXPECT_LT(rms_mm, 0.25);
    EXPECT_EQ(glm::dmat3(held.camera_from_board(begin_s + 0.01)),
              glm::dmat3(held.camera_from_board(begin_s + kHold_s - 0.01)));
  }
}

TEST(HeldBoard, MovesWithoutAJumpFromPlaceToPlaceAndFromTheLastToTheFirst) {
  const auto held = usual();
  double fastest_m_s = 0, moved_m = 0;
  constexpr double kStep_s = 0.01;
  for (double s = -1; s < (HeldBoard::kPlaces + 2) * kPeriod_s; s += kStep_s) {
    const auto pose = held.camera_from_board(s), next = held.camera_from_board(s + kStep_s);
    const glm::dvec4 corner(kBoard.to_m, 0, 1);
    const double step_m = glm::distance(pose * corner, next * corner);
    fastest_m_s = std::max(fastest_m_s, step_m / kStep_s);
    moved_m += step_m;
  }
  EXPECT_LT(fastest_m_s, 1.7);
  EXPECT_GT(moved_m, 3);
}

TEST(HeldBoard, IsMostlyInsideTheImageOfAnyCameraWhateverTheSizeOfTheBoard) {
  auto wide = calib::CameraModel{.fx_px = 520, .fy_px = 520};
  wide.k1 = -0.1;
  const calib::CameraModel tele{1280, 1024, 3200, 3200, 700, 480};
  const BoardOutline large{{0, 0}, {0.42, 0.297}}, small{{0, 0}, {0.1, 0.07}};
  for (const auto& camera : {calib::reference_rig().camera, wide, tele})
    for (const auto& board : {kBoard, large, small})
      for (int seed = 0; seed < 3; ++seed) {
        const auto shares = shares_inside(camera, board, seed);
        EXPECT_GT(shares.least, 0.8) << camera.fx_px << " px, " << board.to_m.x << " m";
        EXPECT_GT(shares.mean, 0.88) << camera.fx_px << " px, " << board.to_m.x << " m";
      }
}

TEST(HeldBoard, TheSeedSelectsThePlaces) {
  EXPECT_EQ(usual(3).camera_from_board(12.3), usual(3).camera_from_board(12.3));
  EXPECT_NE(usual(3).camera_from_board(12.3), usual(4).camera_from_board(12.3));
}

TEST(HeldBoard, AShorterHoldIsTheSamePlacesInLessTime) {
  const HeldBoard brief(calib::reference_rig().camera, kBoard, 1, 0.2);
  const auto held = usual();
  for (int i = 0; i < HeldBoard::kPlaces; ++i)
    EXPECT_LT(glm::distance(brief.camera_from_board(i * (0.2 + HeldBoard::kMove_s) + 0.1)[3],
                            held.camera_from_board(middle_s(i))[3]),
              1e-3);
}

}  // namespace
}  // namespace handcast::twin
