// SPDX-License-Identifier: Apache-2.0
// HandFinder with handcast's model on a stream of the twin's images.
#include <gtest/gtest.h>

#include "services/lab/training/trial.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

using training::Trial;
constexpr std::int64_t kFrame_ns = 5'000'000;
constexpr int kFrames = 960;  ///< of a motion of 4.8 s

Trial trial(int i) {
  static auto trials = training::Trials::open("builtin:open_close", 1);
  EXPECT_TRUE(trials) << trials.error().what;
  return trials->make(i, kFrames).value();
}

Hints left(const Points& points_px) { return {points_px, std::nullopt}; }
Points mirrored(Points points_px, int width_px) {
  for (auto& point : points_px) point.x = static_cast<float>(width_px - 1) - point.x;
  return points_px;
}

class HandcastHandFinder : public testing::Test {
 protected:
  HandcastHandFinder() { open("", 2); }
  /// `folder`: of the palm network; empty: without it.
  void open(const std::filesystem::path& folder, int most_hands,
            HandFinder::Poses poses = HandFinder::Poses::of_a_tracker) {
    auto model = open_landmark_model("handcast", {.folder = folder});
    ASSERT_TRUE(model) << model.error().what;
    finder_.emplace(std::move(*model), most_hands, poses);
  }
  std::vector<FoundHand> find(const test::Grey& image, const Hints& hints = {},
                              std::int64_t step_ns = kFrame_ns) {
    const auto found = finder_->find(image.view(), hints, time_ns_ += step_ns);
    EXPECT_TRUE(found) << found.error().what;
    return found ? std::vector<FoundHand>(found->begin(), found->end()) : std::vector<FoundHand>();
  }
  /// A hand that a hint takes for the other one has its own side 40 images later.
  void expect_wrong_side_is_set_right() {
    const Trial first = trial(100);
    auto found = find(first.image, {std::nullopt, first.tracker_px});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].side, msg::Side::right) << "that of the hint";
    for (int i = 1; i < 40; ++i) found = find(trial(100 + i).image);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].side, msg::Side::left);
  }

  std::optional<HandFinder> finder_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST_F(HandcastHandFinder, FindsAHandWhereTheTrackerSaysAndFollowsItWithoutOne) {
  const Trial first = trial(100);
  auto found = find(first.image, left(first.tracker_px));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(finder_->times().model_runs, 2) << "again around the first estimate";
  EXPECT_LT(distance_px(found[0].points_px, first.truth_px), 8);
  EXPECT_GT(distance_px(first.tracker_px, first.truth_px), 16);
  for (int i = 1; i < 60; ++i) {
    const Trial next = trial(100 + i);
    found = find(next.image);
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(finder_->times().model_runs, i % 8 == 0 ? 2 : 1)
        << "now and then, whether it is not a right hand";
    EXPECT_EQ(found[0].side, msg::Side::left);
    EXPECT_LT(distance_px(found[0].points_px, next.truth_px), 12) << i;
  }
}

TEST_F(HandcastHandFinder, WithoutATrackerNoHandIsFoundWhereNoneWas) {
  EXPECT_TRUE(find(trial(100).image).empty());
}

TEST_F(HandcastHandFinder, AHandThatWasGoneIsFoundAgainWhereItWasOrWhereTheTrackerHasIt) {
  const Trial seen = trial(100);
  const test::Grey black(seen.image.width(), seen.image.height(), 0);
  ASSERT_EQ(find(seen.image, left(seen.tracker_px)).size(), 1u);
  EXPECT_TRUE(find(black, left(seen.tracker_px)).empty());
  EXPECT_TRUE(find(black).empty());
  EXPECT_EQ(find(seen.image).size(), 1u) << "where it was";
  EXPECT_TRUE(find(black).empty());
  EXPECT_TRUE(find(black, {}, 2'000'000'000).empty());
  EXPECT_EQ(find(seen.image).size(), 1u) << "nothing else says where it may be";
  finder_->forget();
  EXPECT_TRUE(find(seen.image).empty());
  EXPECT_EQ(find(seen.image, left(seen.tracker_px)).size(), 1u);
}

TEST_F(HandcastHandFinder, TwoHandsAreTwoAndOneHandIsNeverTwo) {
  const Trial one = trial(100);
  const int width = one.image.width();
  const auto other = test::mirrored(one.image);
  const auto both = test::painted(2 * width, one.image.height(), [&](int x, int y) {
    return x < width ? one.image.at(x, y) : other.at(x - width, y);
  });
  const Points other_px = shifted(mirrored(one.truth_px, width), {width, 0});
  const Hints hints{one.tracker_px, shifted(mirrored(one.tracker_px, width), {width, 0})};
  for (const Hints& told : {hints, Hints{}}) {
    const auto found = find(both, told);
    ASSERT_EQ(found.size(), 2u);
    for (const auto& hand : found)
      EXPECT_LT(distance_px(hand.points_px, hand.side == msg::Side::left ? one.truth_px : other_px),
                10);
  }
  finder_->forget();
  const auto found = find(one.image, {one.tracker_px, shifted(one.tracker_px, {25, 0})});
  ASSERT_EQ(found.size(), 1u) << "the tracker sees a second hand where there is one";
}

TEST_F(HandcastHandFinder,
       MediaPipesPalmNetworkFindsAHandThatNoTrackerSeesAndItIsSurerOfItsOwnSide) {
  SKIP_WITHOUT_MODELS();
  open(test::models(), 1);
  int hands = 0, sides = 0;
  for (int i = 0; i < kFrames; i += 80) {
    const Trial seen = trial(i);
    finder_->forget();
    const auto found = find(seen.image);
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_LT(distance_px(found[0].points_px, seen.truth_px), 12) << i;
    finder_->forget();
    const auto mirrored = find(test::mirrored(seen.image));
    ASSERT_EQ(mirrored.size(), 1u) << i;
    hands += 2;
    sides += (found[0].side == msg::Side::left) + (mirrored[0].side == msg::Side::right);
  }
  EXPECT_GE(sides, hands - 4);
}

TEST_F(HandcastHandFinder, ATrackersHandFarAwayNeitherStopsNorConfusesTheFollowingOfASeenOne) {
  const Trial first = trial(100);
  ASSERT_EQ(find(first.image, left(first.tracker_px)).size(), 1u);
  for (int i = 1; i < 12; ++i) {
    const Trial next = trial(100 + i);
    const auto found = find(next.image, left(shifted(next.tracker_px, {-260, 0})));
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(found[0].side, msg::Side::left);
    EXPECT_LT(distance_px(found[0].points_px, next.truth_px), 12) << i;
  }
}

TEST_F(HandcastHandFinder, WhereTheTrackerHasAHandOutsideTheImageNothingIsLookedAt) {
  const Trial seen = trial(100);
  EXPECT_TRUE(find(seen.image, left(shifted(seen.tracker_px, {-900, 0}))).empty());
  EXPECT_EQ(finder_->times().model_runs, 0);
}

TEST_F(HandcastHandFinder, OfTwoHandsOfTheTrackerTheOneThatIsSeenIsFoundWhereOneIsAskedFor) {
  open("", 1);
  for (int i = 0; i < 5; ++i) {
    const Trial seen = trial(100 + i);
    const int width = seen.image.width();
    const auto found = find(
        test::mirrored(seen.image),
        {shifted(mirrored(seen.tracker_px, width), {-260, 0}), mirrored(seen.tracker_px, width)});
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(found[0].side, msg::Side::right);
  }
}

TEST_F(HandcastHandFinder, AHandThatWasTakenForTheOtherSideIsSetRight) {
  const Trial first = trial(100);
  auto found = find(first.image, {std::nullopt, first.tracker_px});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side, msg::Side::right) << "the tracker knows it better";
  for (int i = 1; i < 100; ++i) found = find(trial(100 + i).image);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side, msg::Side::left);
  EXPECT_LT(distance_px(found[0].points_px, trial(199).truth_px), 12);
}

TEST_F(HandcastHandFinder, WherePosesComeFromLandmarksAWrongSideIsSetRightSoon) {
  open("", 1, HandFinder::Poses::of_landmarks);
  expect_wrong_side_is_set_right();
}

TEST_F(HandcastHandFinder, WherePosesComeFromLandmarksMediaPipesPalmNetworkIsNoHindranceToThat) {
  SKIP_WITHOUT_MODELS();
  open(test::models(), 1, HandFinder::Poses::of_landmarks);
  expect_wrong_side_is_set_right();
}

TEST_F(HandcastHandFinder, HintsThatAreNoNumbersAreNoHints) {
  const Trial seen = trial(100);
  Points broken = seen.tracker_px;
  broken[4].x = NAN;
  EXPECT_TRUE(find(seen.image, left(broken)).empty());
  ASSERT_EQ(find(seen.image, left(seen.tracker_px)).size(), 1u);
  const auto found = find(seen.image, left(broken));
  ASSERT_EQ(found.size(), 1u) << "where it was";
  EXPECT_TRUE(is_finite(found[0].points_px));
}

TEST_F(HandcastHandFinder, NothingItSaysIsNotANumber) {
  const Trial seen = trial(100);
  Points far = seen.tracker_px, point{};
  for (auto& p : far) p *= 1e8f;
  const test::Grey pictures[] = {seen.image, test::noise(720, 540), test::Grey(720, 540, 255),
                                 test::Grey(1, 1, 200), test::Grey(0, 0)};
  for (const auto& picture : pictures)
    for (const Points& hint : {seen.tracker_px, far, point, seen.tracker_px})
      for (const auto& hand : find(picture, left(hint))) {
        EXPECT_TRUE(is_finite(hand.points_px));
        EXPECT_TRUE(std::isfinite(hand.presence));
        for (const float sigma : hand.sigma_px) EXPECT_TRUE(std::isfinite(sigma));
      }
}

}  // namespace
}  // namespace handcast::landmarks
