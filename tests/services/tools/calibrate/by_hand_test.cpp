// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/by_hand.hpp"

#include <gtest/gtest.h>

namespace handcast::calibrate {
namespace {

Key arrow(Key::Arrow direction) { return {0, direction}; }

TEST(DraggedCorners, BeginWithTheHomographyOfTheDraft) {
  const auto draft = calib::reference_rig();
  const auto found = DraggedCorners(draft).homography();
  for (const glm::dvec2 px : {glm::dvec2(0, 0), glm::dvec2(700, 20), glm::dvec2(300, 500)}) {
    const auto mapped = found * glm::dvec3(px, 1);
    EXPECT_LT(glm::distance(glm::dvec2(mapped) / mapped.z, draft.projector.pixel_of(px)), 1e-6);
  }
}

TEST(DraggedCorners, AnArrowMovesOnlyTheChosenCorner) {
  const auto draft = calib::reference_rig();
  DraggedCorners corners(draft);
  const glm::dvec2 third_px(0.9 * 719, 0.9 * 539), first_px(71.9, 53.9);
  EXPECT_TRUE(corners.press({'3'}));
  EXPECT_TRUE(corners.press(arrow(Key::Arrow::right)));
  EXPECT_TRUE(corners.press(arrow(Key::Arrow::down)));
  const auto moved = [&](const glm::dvec2& px) {
    const auto mapped = corners.homography() * glm::dvec3(px, 1);
    return glm::dvec2(mapped) / mapped.z - draft.projector.pixel_of(px);
  };
  EXPECT_LT(glm::distance(moved(third_px), {5, 5}), 1e-6);
  EXPECT_LT(glm::length(moved(first_px)), 1e-6);
}

TEST(DraggedCorners, TheStepCanBeFinerAndCoarserWithinLimits) {
  DraggedCorners corners(calib::reference_rig());
  const auto before_px = corners.chosen_px();
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(corners.press({'-'}));
  corners.press(arrow(Key::Arrow::left));
  EXPECT_NEAR(before_px.x - corners.chosen_px().x, 0.5, 0.2);
  for (int i = 0; i < 20; ++i) corners.press({'+'});
  corners.press(arrow(Key::Arrow::left));
  EXPECT_LT(before_px.x - corners.chosen_px().x, 60);
  EXPECT_EQ(corners.state(), "corner 1 (top left), steps of 50 px");
}

TEST(DraggedCorners, TheMouseDragsTheCornerThatItGrabsByWhereItGrabsIt) {
  DraggedCorners corners(calib::reference_rig());
  const auto before = corners.corners_px();
  ASSERT_TRUE(corners.grab(before[2] + glm::dvec2(10, -5)));
  corners.drag_to(before[2] + glm::dvec2(40, 25));
  corners.drop();
  corners.drag_to({0, 0});
  EXPECT_LT(glm::distance(corners.corners_px()[2], before[2] + glm::dvec2(30, 30)), 1e-9);
  for (const std::size_t other : {0, 1, 3}) EXPECT_EQ(corners.corners_px()[other], before[other]);
  EXPECT_EQ(corners.state(), "corner 3 (bottom right), steps of 5 px") << "arrows go on with it";
}

TEST(DraggedCorners, TheMouseDragsNothingFarFromAllCorners) {
  DraggedCorners corners(calib::reference_rig());
  const auto before = corners.corners_px();
  EXPECT_FALSE(corners.grab((before[0] + before[2]) / 2.0));
  corners.drag_to({5, 5});
  EXPECT_EQ(corners.corners_px(), before);
}

TEST(DraggedCorners, OtherKeysMeanNothing) {
  DraggedCorners corners(calib::reference_rig());
  for (const char key : {'0', '5', 'x', '\x1b'}) EXPECT_FALSE(corners.press({key})) << key;
}

}  // namespace
}  // namespace handcast::calibrate
