// SPDX-License-Identifier: Apache-2.0
// Our own network at work on a stream of the twin's images.
#include "services/landmarks/finder/own_finder.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "ipc/msg/owned.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/finder/hints.hpp"
#include "services/landmarks/training/trial.hpp"
#include "tests/scratch.hpp"
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
Points moved(Points points_px, glm::vec2 by_px) {
  for (auto& point : points_px) point += by_px;
  return points_px;
}
Points mirrored(Points points_px, int width_px) {
  for (auto& point : points_px) point.x = static_cast<float>(width_px - 1) - point.x;
  return points_px;
}

class OwnFinder : public testing::Test {
 protected:
  OwnFinder() : OwnFinder(2) {}
  explicit OwnFinder(int most_hands) {
    auto opened = own::open_finder("", most_hands);
    EXPECT_TRUE(opened) << opened.error().what;
    finder_.emplace(std::move(*opened));
  }
  std::vector<FoundHand> look(const test::Grey& image, const Hints& hints = {},
                              std::int64_t step_ns = kFrame_ns) {
    const auto found = finder_->find(image.view(), hints, time_ns_ += step_ns);
    EXPECT_TRUE(found) << found.error().what;
    return found ? std::vector<FoundHand>(found->begin(), found->end()) : std::vector<FoundHand>();
  }

  std::optional<HandFinder> finder_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST_F(OwnFinder, FindsAHandWhereTheTrackerSaysAndFollowsItWithoutOne) {
  const Trial first = trial(100);
  auto found = look(first.image, left(first.tracker_px));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(finder_->times().looks, 2) << "again around what was seen";
  EXPECT_LT(distance_px(found[0].points_px, first.truth_px), 8);
  EXPECT_GT(distance_px(first.tracker_px, first.truth_px), 16);
  for (int i = 1; i < 60; ++i) {
    const Trial next = trial(100 + i);
    found = look(next.image);
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(finder_->times().looks, i % 8 == 0 ? 2 : 1)
        << "now and then, whether it is not a right hand";
    EXPECT_EQ(found[0].side, msg::Side::left);
    EXPECT_LT(distance_px(found[0].points_px, next.truth_px), 12) << i;
  }
}

TEST_F(OwnFinder, WithoutATrackerNoHandIsFoundWhereNoneWas) {
  EXPECT_TRUE(look(trial(100).image).empty());
}

TEST_F(OwnFinder, AHandThatWasGoneIsFoundAgainWhereItWasOrWhereTheTrackerHasIt) {
  const Trial seen = trial(100);
  const test::Grey black(seen.image.width(), seen.image.height(), 0);
  ASSERT_EQ(look(seen.image, left(seen.tracker_px)).size(), 1u);
  EXPECT_TRUE(look(black, left(seen.tracker_px)).empty());
  EXPECT_TRUE(look(black).empty());
  EXPECT_EQ(look(seen.image).size(), 1u) << "where it was";
  EXPECT_TRUE(look(black).empty());
  EXPECT_TRUE(look(black, {}, 2'000'000'000).empty());
  EXPECT_EQ(look(seen.image).size(), 1u) << "nothing else says where it may be";
  finder_->forget();
  EXPECT_TRUE(look(seen.image).empty());
  EXPECT_EQ(look(seen.image, left(seen.tracker_px)).size(), 1u);
}

TEST_F(OwnFinder, TwoHandsAreTwoAndOneHandIsNeverTwo) {
  const Trial one = trial(100);
  const int width = one.image.width();
  const auto other = test::mirrored(one.image);
  const auto both = test::painted(2 * width, one.image.height(), [&](int x, int y) {
    return x < width ? one.image.at(x, y) : other.at(x - width, y);
  });
  const Points other_px = moved(mirrored(one.truth_px, width), {width, 0});
  const Hints hints{one.tracker_px, moved(mirrored(one.tracker_px, width), {width, 0})};
  for (const Hints& told : {hints, Hints{}}) {
    const auto found = look(both, told);
    ASSERT_EQ(found.size(), 2u);
    for (const auto& hand : found)
      EXPECT_LT(distance_px(hand.points_px, hand.side == msg::Side::left ? one.truth_px : other_px),
                10);
  }
  finder_->forget();
  const auto found = look(one.image, {one.tracker_px, moved(one.tracker_px, {25, 0})});
  ASSERT_EQ(found.size(), 1u) << "the tracker sees a second hand where there is one";
}

TEST_F(OwnFinder, MediaPipesPalmNetworkFindsAHandThatNoTrackerSeesAndItIsSurerOfItsOwnSide) {
  SKIP_WITHOUT_MODELS();
  finder_.emplace(std::move(*own::open_finder(test::models(), 1)));
  int hands = 0, sides = 0;
  for (int i = 0; i < kFrames; i += 80) {
    const Trial seen = trial(i);
    finder_->forget();
    const auto found = look(seen.image);
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_LT(distance_px(found[0].points_px, seen.truth_px), 12) << i;
    finder_->forget();
    const auto mirrored = look(test::mirrored(seen.image));
    ASSERT_EQ(mirrored.size(), 1u) << i;
    hands += 2;
    sides += (found[0].side == msg::Side::left) + (mirrored[0].side == msg::Side::right);
  }
  EXPECT_GE(sides, hands - 4);
}

TEST_F(OwnFinder, ATrackersHandFarAwayNeitherStopsNorConfusesTheFollowingOfASeenOne) {
  const Trial first = trial(100);
  ASSERT_EQ(look(first.image, left(first.tracker_px)).size(), 1u);
  for (int i = 1; i < 12; ++i) {
    const Trial next = trial(100 + i);
    const auto found = look(next.image, left(moved(next.tracker_px, {-260, 0})));
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(found[0].side, msg::Side::left);
    EXPECT_LT(distance_px(found[0].points_px, next.truth_px), 12) << i;
  }
}

TEST_F(OwnFinder, WhereTheTrackerHasAHandOutsideTheImageNothingIsLookedAt) {
  const Trial seen = trial(100);
  EXPECT_TRUE(look(seen.image, left(moved(seen.tracker_px, {-900, 0}))).empty());
  EXPECT_EQ(finder_->times().looks, 0);
}

TEST_F(OwnFinder, OfTwoHandsOfTheTrackerTheOneThatIsSeenIsFoundWhereOneIsAskedFor) {
  finder_.emplace(std::move(*own::open_finder("", 1)));
  for (int i = 0; i < 5; ++i) {
    const Trial seen = trial(100 + i);
    const int width = seen.image.width();
    const auto found = look(
        test::mirrored(seen.image),
        {moved(mirrored(seen.tracker_px, width), {-260, 0}), mirrored(seen.tracker_px, width)});
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(found[0].side, msg::Side::right);
  }
}

TEST_F(OwnFinder, AHandThatWasTakenForTheOtherSideIsSetRight) {
  const Trial first = trial(100);
  auto found = look(first.image, {std::nullopt, first.tracker_px});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side, msg::Side::right) << "the tracker knows it better";
  for (int i = 1; i < 100; ++i) found = look(trial(100 + i).image);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].side, msg::Side::left);
  EXPECT_LT(distance_px(found[0].points_px, trial(199).truth_px), 12);
}

TEST_F(OwnFinder, HintsThatAreNoNumbersAreNoHints) {
  const Trial seen = trial(100);
  Points broken = seen.tracker_px;
  broken[4].x = NAN;
  EXPECT_TRUE(look(seen.image, left(broken)).empty());
  ASSERT_EQ(look(seen.image, left(seen.tracker_px)).size(), 1u);
  const auto found = look(seen.image, left(broken));
  ASSERT_EQ(found.size(), 1u) << "where it was";
  EXPECT_TRUE(is_finite(found[0].points_px));
}

TEST_F(OwnFinder, NothingItSaysIsNotANumber) {
  const Trial seen = trial(100);
  Points far = seen.tracker_px, point{};
  for (auto& p : far) p *= 1e8f;
  const test::Grey pictures[] = {seen.image, test::noise(720, 540), test::Grey(720, 540, 255),
                                 test::Grey(1, 1, 200), test::Grey(0, 0)};
  for (const auto& picture : pictures)
    for (const Points& hint : {seen.tracker_px, far, point, seen.tracker_px})
      for (const auto& hand : look(picture, left(hint))) {
        EXPECT_TRUE(is_finite(hand.points_px));
        EXPECT_TRUE(std::isfinite(hand.presence));
        for (const float sigma : hand.sigma_px) EXPECT_TRUE(std::isfinite(sigma));
      }
}

/// Sees a hand wherever it looks, 10 px right of the region's middle, and writes down what it was
/// told.
class Scribe final : public LandmarkModel {
 public:
  struct Look {
    Region region;
    msg::Side side;
    std::optional<Points> tracker_px;
  };
  explicit Scribe(std::vector<Look>& looks) : looks_(looks) {}
  Region region_around(const Points& points_px) const override {
    return {centre_of(points_px), 100, 0};
  }
  int first_looks() const override { return 2; }
  bool tells_sides() const override { return false; }
  Result<Seen> look(renderer::GreyView, const Region& region, msg::Side side,
                    const std::optional<Points>& tracker_px, Times&) override {
    looks_.push_back({region, side, tracker_px});
    Seen seen{.presence = 1};
    seen.points_px.fill(region.centre_px + glm::vec2(10, 0));
    return seen;
  }

 private:
  std::vector<Look>& looks_;
};

TEST(LandmarkModel, IsToldTheSideAndTheTrackersJointsOfEachHandWhereThereAreAny) {
  std::vector<Scribe::Look> looks;
  HandFinder finder(std::make_unique<Scribe>(looks), std::nullopt, 2);
  const test::Grey image(720, 540, 0);
  Points left_px, right_px;
  left_px.fill({200, 300});
  right_px.fill({500, 300});
  ASSERT_TRUE(finder.find(image.view(), {left_px, right_px}, 1));
  ASSERT_EQ(looks.size(), 4u) << "twice a hand";
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(looks[i].side, i < 2 ? msg::Side::left : msg::Side::right);
    EXPECT_EQ(looks[i].tracker_px, i < 2 ? left_px : right_px);
    EXPECT_EQ(looks[i].region.centre_px.x, (i < 2 ? 200 : 500) + (i % 2 ? 10 : 0));
  }
  looks.clear();
  ASSERT_TRUE(finder.find(image.view(), {std::nullopt, right_px}, 2));
  ASSERT_EQ(looks.size(), 2u) << "once a hand that is followed";
  for (const auto& look : looks)
    EXPECT_EQ(look.tracker_px.has_value(), look.side == msg::Side::right);
}

/// What the detector says of one image whose tracker is right.
class OwnDetector : public testing::Test {
 protected:
  msg::Landmarks detect(const test::Grey& image, const Points& tracker_px) {
    config::Rig rig;
    rig.landmarks.backend = "own";
    rig.landmarks.models = scratch_.path();
    const auto detector = open_detector(rig, calib::reference_rig(), 0);
    EXPECT_TRUE(detector) << detector.error().what;
    msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(image.width(), image.height()));
    frame->width_px = image.width();
    frame->height_px = image.height();
    std::ranges::copy(image.pixels(), frame->pixels());
    const auto found = (*detector)->detect(
        *frame, left(undistorted(calib::reference_rig().camera, tracker_px)), Deadline::now());
    EXPECT_TRUE(found) << found.error().what;
    return *found;
  }
  float mean_confidence(const test::Grey& image, const Points& tracker_px) {
    const auto found = detect(image, tracker_px);
    float sum = 0;
    for (std::uint32_t i = 0; i < found.count; ++i)
      for (const auto& point : found.hands[i].points) sum += point.confidence / msg::kLandmarks;
    return sum;
  }
  test::Scratch scratch_;
};

TEST_F(OwnDetector, ConfidenceFallsAsNoiseRises) {
  const Trial seen = trial(100);
  const auto noise = test::noise(720, 540);
  const auto noisy = [&](double share) {
    return mean_confidence(test::painted(720, 540,
                                         [&](int x, int y) {
                                           return (1 - share) * seen.image.at(x, y) +
                                                  share * noise.at(x, y);
                                         }),
                           seen.tracker_px);
  };
  const float clean = noisy(0), grainy = noisy(0.6), lost = noisy(0.95);
  EXPECT_GT(clean, 0.8f);
  EXPECT_LT(grainy, clean - 0.05f);
  EXPECT_LT(lost, grainy - 0.05f);
}

TEST_F(OwnDetector, ALandmarkThatIsHiddenIsLessSureThanOneThatIsSeen) {
  const Trial seen = trial(0);
  const auto tip = static_cast<int>(seen.truth_px[12].y + 0.35f * palm_length_px(seen.truth_px));
  const auto found = detect(test::covered(seen.image, test::Hidden::above, tip), seen.tracker_px);
  ASSERT_EQ(found.count, 1u);
  EXPECT_LT(found.hands[0].points[12].confidence, found.hands[0].points[0].confidence - 0.1f);
}

TEST_F(OwnDetector, ATrackersHandThatIsAPointOrFarAwayIsNoHand) {
  const Trial seen = trial(100);
  Points point;
  point.fill(seen.tracker_px[9]);
  EXPECT_EQ(detect(seen.image, point).count, 0u);
  EXPECT_EQ(detect(seen.image, moved(seen.tracker_px, {3000, 0})).count, 0u);
}

TEST_F(OwnDetector, SaysThatItsFileIsMissing) {
  const char* before = std::getenv("HANDCAST_ASSETS");
  const std::string kept = before ? before : "";
  setenv("HANDCAST_ASSETS", scratch_.path().c_str(), 1);
  config::Rig rig;
  rig.landmarks.backend = "own";
  const auto detector = open_detector(rig, calib::reference_rig(), 0);
  before ? setenv("HANDCAST_ASSETS", kept.c_str(), 1) : unsetenv("HANDCAST_ASSETS");
  ASSERT_FALSE(detector);
  EXPECT_EQ(detector.error().code, Errc::bad_config);
  EXPECT_THAT(detector.error().what,
              testing::AllOf(testing::HasSubstr(
                                 "landmarks/handcast.onnx', which comes with handcast, is missing"),
                             testing::Not(testing::HasSubstr("\n"))));
}

}  // namespace
}  // namespace handcast::landmarks
