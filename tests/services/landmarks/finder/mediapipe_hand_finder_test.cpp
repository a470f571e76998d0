// SPDX-License-Identifier: Apache-2.0
// HandFinder with MediaPipe Hands on real captures and on hostile pictures.
#include <gtest/gtest.h>

#include <cmath>

#include "services/landmarks/finder/hand_finder.hpp"
#include "services/landmarks/models/mediapipe_model.hpp"
#include "services/landmarks/models/mediapipe_palms.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

constexpr std::int64_t kFrame_ns = 2'000'000;
constexpr int kTips[] = {4, 8, 12, 16, 20};

class MediapipeHandFinder : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_MODELS();
    SKIP_WITHOUT_CAPTURES();
    open(2);
  }
  void open(int most_hands) {
    auto model = open_landmark_model("mediapipe", {.folder = test::models()});
    ASSERT_TRUE(model) << model.error().what;
    finder_.emplace(std::move(*model), most_hands);
  }

  /// The next image of a stream; the tracker sees what the capture's did, or nothing.
  std::vector<FoundHand> find(const test::Grey& image, const Hints& hints = {}) {
    const auto found = finder_->find(image.view(), hints, time_ns_ += kFrame_ns);
    EXPECT_TRUE(found) << found.error().what;
    return found ? std::vector<FoundHand>(found->begin(), found->end()) : std::vector<FoundHand>();
  }
  static Hints left(const Points& points) { return {points, std::nullopt}; }

  std::optional<HandFinder> finder_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST_F(MediapipeHandFinder, FindsEachRealHandWhereTheTrackerSaysAndWithoutIt) {
  for (const int number : test::kCaptures) {
    const auto capture = *test::capture(number);
    finder_->forget();
    const auto hinted = find(capture.image, left(capture.tracker_px));
    ASSERT_EQ(hinted.size(), 1u) << number;
    EXPECT_GT(hinted[0].presence, 0.97f) << number;
    EXPECT_EQ(hinted[0].side, msg::Side::left);
    EXPECT_EQ(finder_->times().palm_runs, 0) << "the tracker is enough";
    finder_->forget();
    const auto searched = find(capture.image);
    ASSERT_EQ(searched.size(), 1u) << number;
    EXPECT_EQ(searched[0].side, msg::Side::left)
        << number << ": the network's word, of an image that is not mirrored";
    EXPECT_LT(distance_px(hinted[0].points_px, searched[0].points_px), 8) << number;
  }
}

/// From a landmark at the tip of a finger along the finger to its end, and across to its sides.
struct TipInItsFinger {
  float to_end_px = 0, to_right_px = 0, to_left_px = 0;
};
TipInItsFinger measure(const test::Grey& image, const Points& points, int tip) {
  const glm::vec2 along = glm::normalize(points[tip] - points[tip - 1]), across(-along.y, along.x);
  const auto way = [&](glm::vec2 from, glm::vec2 direction) {
    float length = 0;
    const auto is_hand = [&](glm::vec2 at) {
      return image.at(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))) >
             30;
    };
    while (length < 40 && is_hand(from + direction * (length + 0.5f))) length += 0.5f;
    return length;
  };
  const glm::vec2 below = points[tip] - 4.0f * along;
  return {way(points[tip], along), way(below, across), way(below, -across)};
}

// 14 tips that stand alone before the dark; the palm is 128 to 158 px long. No file of annotations
// exists: a tip is right where it lies on the middle line of its finger and as far from the end as
// the finger is wide to one side.
TEST_F(MediapipeHandFinder, TipsLieAtTheEndsOfTheFingers) {
  double sum = 0;
  int count = 0;
  for (const int number : test::kCaptures) {
    const auto capture = *test::capture(number);
    finder_->forget();
    const auto found = find(capture.image, left(capture.tracker_px));
    ASSERT_EQ(found.size(), 1u);
    for (const int tip : kTips) {
      const auto place = measure(capture.image, found[0].points_px, tip);
      const float half_width = (place.to_left_px + place.to_right_px) / 2;
      if (place.to_end_px >= 40 || half_width > 20) continue;  // before the palm or another finger
      sum += std::hypot((place.to_right_px - place.to_left_px) / 2, place.to_end_px - half_width);
      ++count;
    }
  }
  ASSERT_GE(count, 14);
  RecordProperty("tip_error_px", std::to_string(sum / count));
  EXPECT_LT(sum / count, 6.5) << count << " tips";
}

// The half-pixel trap: what a place in the crop is called must not depend on which way the image is
// turned over.
TEST_F(MediapipeHandFinder, AMirroredImageGivesMirroredLandmarks) {
  auto model = MediapipeModel::open(test::models() / kMediapipeHandFile);
  ASSERT_TRUE(model) << model.error().what;
  EstimateTimes times;
  const auto estimate = [&](const test::Grey& image, const Region& region) {
    return model->estimate(image.view(), region, msg::Side::left, std::nullopt, times)->points_px;
  };
  double sum = 0;
  int count = 0;
  for (const int number : test::kCaptures) {
    const auto capture = *test::capture(number);
    const auto mirrored = test::mirrored(capture.image);
    const Region first =
        model->region_around(estimate(capture.image, model->region_around(capture.tracker_px)));
    for (const float turn_rad : {-0.15f, -0.05f, 0.05f, 0.15f}) {
      Region region = first, other = first;
      region.angle_rad += turn_rad;
      other.angle_rad = -region.angle_rad;
      other.centre_px.x = static_cast<float>(capture.image.width() - 1) - region.centre_px.x;
      const Points points_px = estimate(capture.image, region),
                   mirrored_px = estimate(mirrored, other);
      for (std::size_t i = 0; i < points_px.size(); ++i, ++count)
        sum += region.to_place(points_px[i]).x + other.to_place(mirrored_px[i]).x;
    }
  }
  EXPECT_LT(std::abs(224 * sum / count / 2), 0.4) << "px of the crop; half a pixel off gives 0.7";
}

TEST_F(MediapipeHandFinder, DimAndBrightLightGiveTheSameLandmarks) {
  const auto capture = *test::capture(3);
  const auto usual = find(capture.image, left(capture.tracker_px));
  for (const double gain : {0.3, 0.6, 1.6}) {
    finder_->forget();
    const auto found = find(test::brightened(capture.image, gain), left(capture.tracker_px));
    ASSERT_EQ(found.size(), 1u) << gain;
    EXPECT_LT(distance_px(found[0].points_px, usual[0].points_px), 1.5) << gain;
  }
}

TEST_F(MediapipeHandFinder, FollowsAHandWithoutThePalmNetworkOrATracker) {
  const auto capture = *test::capture(8);
  ASSERT_EQ(find(capture.image).size(), 1u);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(find(capture.image).size(), 1u);
    EXPECT_EQ(finder_->times().palm_runs, 0);
    EXPECT_EQ(finder_->times().model_runs, 1);
  }
}

TEST_F(MediapipeHandFinder, ATrackersMotionMovesTheRegionOn) {
  const auto capture = *test::capture(6);
  const auto before = find(capture.image, left(capture.tracker_px));
  ASSERT_EQ(before.size(), 1u);
  const int jump_px = 200;
  const auto image = test::overlaid(test::Grey(capture.image.width(), capture.image.height(), 8),
                                    capture.image, jump_px);
  Points moved_px = capture.tracker_px;
  for (auto& point : moved_px) point.x += jump_px;
  const auto found = find(image, left(moved_px));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].points_px[12].x, before[0].points_px[12].x + jump_px, 6);
  const Region last = mediapipe_region_of_landmarks(before[0].points_px);
  EXPECT_NEAR(found[0].region.centre_px.x, last.centre_px.x + jump_px, 1)
      << "the last landmarks' region, where the tracker moved";
  EXPECT_NEAR(found[0].region.centre_px.y, last.centre_px.y, 1);
}

TEST_F(MediapipeHandFinder, TwoHandsAreTwoAndOneHandIsNeverTwo) {
  const auto capture = *test::capture(6);
  const auto both = test::overlaid(capture.image, test::mirrored(capture.image), -100);
  auto found = find(both);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].side, found[1].side);
  EXPECT_GT(distance_px(found[0].points_px, found[1].points_px), 200);
  for (const auto& hand : found) EXPECT_EQ(hand.side == msg::Side::left, hand.points_px[9].x < 512);

  finder_->forget();
  Points beside = capture.tracker_px;
  for (auto& point : beside) point.x += 25;
  found = find(capture.image, {capture.tracker_px, beside});
  ASSERT_EQ(found.size(), 1u) << "the tracker sees a second hand where there is one";
  EXPECT_EQ(found[0].side, msg::Side::left) << "the one that is nearer to its joints";
}

TEST_F(MediapipeHandFinder, NoMoreHandsThanAreAskedFor) {
  open(1);
  const auto capture = *test::capture(6);
  const auto both = test::overlaid(capture.image, test::mirrored(capture.image), -100);
  EXPECT_EQ(find(both).size(), 1u);
  EXPECT_EQ(find(both, left(capture.tracker_px)).size(), 1u);
}

TEST_F(MediapipeHandFinder, TheTrackerKnowsTheSideBetterThanTheNetwork) {
  const auto capture = *test::capture(6);
  const auto found = find(capture.image, {std::nullopt, capture.tracker_px});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side, msg::Side::right);
}

TEST_F(MediapipeHandFinder, OverlappingHandsAreAtMostTwoAndFinite) {
  const auto capture = *test::capture(6);
  const auto both = test::overlaid(capture.image, test::capture(1)->image, -60);
  const auto found = find(both, {capture.tracker_px, test::capture(1)->tracker_px});
  EXPECT_LE(found.size(), 2u);
  for (const auto& hand : found) EXPECT_TRUE(is_finite(hand.points_px));
}

class HostileImages : public MediapipeHandFinder {
 protected:
  /// Neither where the tracker claims a hand nor by search is one found; the next good image's is.
  void expect_no_hand(const test::Grey& image, const char* what) {
    const auto capture = *test::capture(6);
    finder_->forget();
    EXPECT_TRUE(find(image, left(capture.tracker_px)).empty()) << what;
    EXPECT_TRUE(find(image).empty()) << what;
    EXPECT_EQ(find(capture.image, left(capture.tracker_px)).size(), 1u) << what << ": no recovery";
  }
};

TEST_F(HostileImages, WithoutAHandGiveNoHand) {
  const int width = 1024, height = 768;
  expect_no_hand(test::Grey(width, height, 0), "black");
  expect_no_hand(test::Grey(width, height, 255), "white");
  expect_no_hand(test::noise(width, height), "noise");
  expect_no_hand(test::face(width, height), "a face");
  expect_no_hand(test::painted(width, height, [](int x, int) { return x / 16 % 2 ? 200 : 20; }),
                 "stripes");
  expect_no_hand(test::covered(test::capture(6)->image, test::Hidden::above, 430),
                 "an arm without its hand");
}

TEST_F(HostileImages, WithoutPixelsOrWithFewGiveNoHand) {
  expect_no_hand(test::Grey(0, 0), "empty");
  expect_no_hand(test::Grey(1, 1, 200), "one pixel");
  expect_no_hand(test::Grey(3, 2, 200), "six pixels");
  expect_no_hand(test::Grey(1024, 1, 200), "a line");
}

TEST_F(HostileImages, ConfidenceFallsAsAHandIsBlurredOrHidden) {
  const auto capture = *test::capture(6);
  const auto presence = [&](const test::Grey& image) {
    finder_->forget();
    const auto found = find(image, left(capture.tracker_px));
    return found.empty() ? 0 : found[0].presence;
  };
  const float good = presence(capture.image),
              half = presence(test::covered(capture.image, test::Hidden::right, 290));
  const float smeared = presence(test::blurred(capture.image, 30, 0));
  EXPECT_GT(good, 0.97f);
  EXPECT_LT(half, good - 0.1f) << "half a hand";
  EXPECT_LT(smeared, good - 0.04f);
  EXPECT_EQ(presence(test::blurred(capture.image, 80, 0)), 0) << "smeared over a palm's length";
  EXPECT_EQ(presence(test::blurred(capture.image, 45, 45)), 0);
}

TEST_F(HostileImages, AreForgottenWithTheNextGoodOneWithoutATrackerToo) {
  const auto capture = *test::capture(3);
  ASSERT_EQ(find(capture.image).size(), 1u);
  const auto before = find(capture.image);
  for (const int bad_images : {1, 2, 3}) {
    for (int i = 0; i < bad_images; ++i) EXPECT_TRUE(find(test::noise(1024, 768)).empty());
    const auto after = find(capture.image);
    ASSERT_EQ(after.size(), 1u) << bad_images;
    EXPECT_LT(distance_px(before[0].points_px, after[0].points_px), 6);
  }
}

TEST_F(HostileImages, HintsThatAreNoNumbersAreNoHints) {
  const auto capture = *test::capture(6);
  Points broken = capture.tracker_px;
  broken[4].x = NAN;
  EXPECT_EQ(find(capture.image, left(broken)).size(), 1u);
  finder_->forget();
  Points far = capture.tracker_px;
  for (auto& point : far) point *= 1e8f;
  EXPECT_EQ(find(capture.image, left(far)).size(), 1u) << "by the palm network";
}

}  // namespace
}  // namespace handcast::landmarks
