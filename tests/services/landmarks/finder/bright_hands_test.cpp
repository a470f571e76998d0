// SPDX-License-Identifier: Apache-2.0
// Hands that are found by their brightness alone, without tracker and palm network.
#include <gtest/gtest.h>

#include "services/lab/training/trial.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

using training::Trial;

Trial trial(const std::string& motion, int i, int count) {
  auto trials = training::Trials::open("builtin:" + motion, 3);
  EXPECT_TRUE(trials) << trials.error().what;
  return trials->make(i, count).value();
}

/// The image turned by a quarter, clockwise.
test::Grey turned_right(const test::Grey& image) {
  return test::painted(image.height(), image.width(),
                       [&](int x, int y) { return image.at(y, image.height() - 1 - x); });
}
Points turned_right(Points points_px, int height_px) {
  for (auto& point : points_px) point = {static_cast<float>(height_px - 1) - point.y, point.x};
  return points_px;
}

class BrightHandFinder : public testing::Test {
 protected:
  BrightHandFinder() { forget(); }
  void forget() {
    auto model = open_landmark_model("handcast", {});
    ASSERT_TRUE(model) << model.error().what;
    finder_.emplace(std::move(*model), 2, HandFinder::Poses::of_landmarks);
  }
  std::vector<FoundHand> find(const test::Grey& image, std::int64_t step_ns = 5'000'000) {
    const auto found = finder_->find(image.view(), {}, time_ns_ += step_ns);
    EXPECT_TRUE(found) << found.error().what;
    return found ? std::vector<FoundHand>(found->begin(), found->end()) : std::vector<FoundHand>();
  }

  std::optional<HandFinder> finder_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST_F(BrightHandFinder, FindsOpenClosedAndTurnedHandsAtOnce) {
  for (const auto* motion : {"open_close", "fist", "flip", "point_at_camera"})
    for (int i = 0; i < 4; ++i) {
      const Trial seen = trial(motion, i, 4);
      forget();
      const auto found = find(seen.image);
      ASSERT_EQ(found.size(), 1u) << motion << ' ' << i;
      EXPECT_LT(distance_px(found[0].points_px, seen.truth_px), 20) << motion << ' ' << i;
    }
}

TEST_F(BrightHandFinder, FindsHandsThatPointInAnyDirection) {
  const Trial seen = trial("wave", 0, 4);
  auto image = seen.image;
  Points truth_px = seen.truth_px;
  for (int quarter = 0; quarter < 4; ++quarter) {
    forget();
    const auto found = find(image);
    ASSERT_EQ(found.size(), 1u) << quarter;
    EXPECT_LT(distance_px(found[0].points_px, truth_px), 15) << quarter;
    truth_px = turned_right(truth_px, image.height());
    image = turned_right(image);
  }
}

TEST_F(BrightHandFinder, SaysWhichHandItIsWhereTheImageShowsIt) {
  for (const auto* motion : {"wave", "open_close", "pinch", "fist"}) {
    const Trial seen = trial(motion, 1, 4);
    forget();
    auto found = find(seen.image);
    ASSERT_EQ(found.size(), 1u) << motion;
    EXPECT_EQ(found[0].side, seen.side) << motion;
    forget();
    found = find(test::mirrored(seen.image));
    ASSERT_EQ(found.size(), 1u) << motion;
    EXPECT_NE(found[0].side, seen.side) << motion;
  }
}

TEST_F(BrightHandFinder, AHandThatLeavesAndReturnsElsewhereIsFoundAgain) {
  const Trial seen = trial("wave", 0, 4);
  const int shift = seen.truth_px[9].x > 360 ? -150 : 150;
  const auto moved = test::painted(seen.image.width(), seen.image.height(), [&](int x, int y) {
    const int from = x - shift;
    return from >= 0 && from < seen.image.width() ? seen.image.at(from, y) : std::uint8_t{9};
  });
  const test::Grey empty(seen.image.width(), seen.image.height(), 9);
  ASSERT_EQ(find(seen.image).size(), 1u);
  for (int i = 0; i < 80; ++i) EXPECT_TRUE(find(empty).empty());
  std::vector<FoundHand> found;
  for (int i = 0; i < 4 && found.empty(); ++i) found = find(moved);
  ASSERT_EQ(found.size(), 1u) << "within four images";
  EXPECT_LT(distance_px(found[0].points_px, shifted(seen.truth_px, {shift, 0})), 12);
}

TEST_F(BrightHandFinder, TwoHandsAreFoundAndNamedLeftAndRight) {
  const Trial one = trial("wave", 0, 4);
  const int width = one.image.width();
  const auto other = test::mirrored(one.image);
  const auto both = test::painted(2 * width, one.image.height(), [&](int x, int y) {
    return x < width ? one.image.at(x, y) : other.at(x - width, y);
  });
  const auto found = find(both);
  ASSERT_EQ(found.size(), 2u);
  for (const auto& hand : found)
    EXPECT_EQ(hand.side == one.side, centre_of(hand.points_px).x < static_cast<float>(width));
}

TEST_F(BrightHandFinder, AHandInADarkImageIsFound) {
  const Trial seen = trial("wave", 0, 4);
  const auto dark = test::painted(seen.image.width(), seen.image.height(),
                                  [&](int x, int y) { return 0.2 * seen.image.at(x, y); });
  const auto found = find(dark);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(distance_px(found[0].points_px, seen.truth_px), 15);
}

TEST_F(BrightHandFinder, NothingIsFoundWhereThereIsNoHand) {
  for (const auto& image : {test::Grey(720, 540, 0), test::Grey(720, 540, 255),
                            test::noise(720, 540), test::face(720, 540), test::Grey(3, 2, 50)}) {
    forget();
    EXPECT_TRUE(find(image).empty()) << image.width();
  }
}

TEST(BrightHands, ThePalmAndTheDirectionOfTheFingersComeFirst) {
  BrightHands bright;
  const Trial seen = trial("wave", 0, 4);
  const auto found = bright.search(seen.image.view(), {});
  ASSERT_EQ(found.size(), 1u);
  const Region& first = found[0].regions[0];
  const glm::vec2 up = glm::normalize(seen.truth_px[9] - seen.truth_px[0]);
  EXPECT_GT(glm::dot(up, turned({0, -1}, first.angle_rad)), 0.7f);
  for (const glm::vec2 point : seen.truth_px) {
    const glm::vec2 place = glm::abs(first.to_place(point));
    EXPECT_LT(std::max(place.x, place.y), 0.6f);
  }
}

TEST(BrightHands, AKnownHandIsNotFoundAgain) {
  BrightHands bright;
  const Trial seen = trial("wave", 0, 4);
  EXPECT_TRUE(bright.search(seen.image.view(), std::vector{seen.truth_px}).empty());
}

}  // namespace
}  // namespace handcast::landmarks
