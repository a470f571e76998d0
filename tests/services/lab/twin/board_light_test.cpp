// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "tests/services/lab/twin/board_world.hpp"

/// The projector's light in the camera's images of a board that is held.
namespace handcast::twin {
namespace {

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

TEST(BoardLight, ASpotOfLightIsWhereTheProjectorSendsIt) {
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

TEST(BoardLight, LightBesideItIsOnTheTableOneMetreAway) {
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

TEST(BoardLight, AFilterThatLeaksNothingHidesTheProjector) {
  const auto rig = board_rig(0);
  const auto twin = twin_with(rig, blank());
  const auto k = frame_at(rig, 0);
  EXPECT_EQ(lit_shot(*twin, k, spot(512, 384, 200)).pixels(), shot(*twin, k).pixels());
}

TEST(BoardLight, ADarkProjectorIsNoProjector) {
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

TEST(BoardLight, LightThatIsHalfAsStrongAddsHalfAsMuch) {
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

TEST(BoardLight, HandsTakeNoNoticeOfTheProjectorsLight) {
  const auto rig = rig_with("builtin:still");
  const auto twin = twin_of(rig);
  EXPECT_EQ(lit_shot(*twin, 3, spot(512, 384, 200)).pixels(), shot(*twin, 3).pixels());
  EXPECT_FALSE(twin->board_pose(0));
}

}  // namespace
}  // namespace handcast::twin
