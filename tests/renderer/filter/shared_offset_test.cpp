// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/shared_offset.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "config/settings/choice.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::renderer {
namespace {

constexpr int kTip = 8;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();
using Offsets = std::array<glm::vec2, kLandmarks>;
using Sigmas = std::array<float, kLandmarks>;

/// A resting hand. Its landmarks are 10 px right of the tracker's and have a sigma of 2 px.
class SharedOffset : public testing::TestWithParam<const char*> {
 protected:
  SharedOffset() {
    offsets_.fill({10, 0});
    sigmas_.fill(2);
  }

  /// The offsets of a filter after these detections.
  Offsets carried(LandmarkFilter::Tracker tracker = LandmarkFilter::Tracker::reporting) const {
    config::Filter settings;
    settings.method = *config::choice_named<config::FilterMethod>(GetParam());
    settings.blend_ms = 0;
    const auto filter = make_landmark_filter(settings);
    LandmarkPoints still;
    for (int i = 0; i < kLandmarks; ++i) still[i] = glm::vec2(300 + 3 * i, 200 + 5 * i);
    msg::HandLandmarks seen;
    for (int i = 0; i < kLandmarks; ++i)
      seen.points[i] = {still[i].x + offsets_[i].x, still[i].y + offsets_[i].y, 1, sigmas_[i]};
    filter->tracker_is(tracker);
    for (int ms = 0; ms < 200; ms += 4)
      filter->detection(ms * kMs, (ms - 4) * kMs, seen,
                        [&](std::int64_t) { return std::optional(still); });
    Offsets moved = *filter->at(200 * kMs, 204 * kMs, still);
    for (int i = 0; i < kLandmarks; ++i) moved[i] -= still[i];
    return moved;
  }

  Offsets offsets_{};
  Sigmas sigmas_{};
};
INSTANTIATE_TEST_SUITE_P(Filters, SharedOffset, testing::Values("offset_kalman", "one_euro"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(SharedOffset, ALandmarkTheDetectorIsUnsureOfGoesWithTheHand) {
  offsets_[kTip].x = 22;
  EXPECT_NEAR(carried()[kTip].x, 22, 1.5) << "sigma is 2 px";
  sigmas_[kTip] = 14;
  EXPECT_LT(carried()[kTip].x, 13);
  EXPECT_NEAR(carried()[kTip - 1].x, 10, 0.5) << "others do not move";
}

TEST_P(SharedOffset, AFingerTheTrackerHasWrongIsPutRightThoughTheDetectorIsUnsureOfIt) {
  for (int i = 5; i <= 8; ++i) {
    offsets_[i].x = 60;
    sigmas_[i] = 9;
  }
  for (int i = 5; i <= 8; ++i) EXPECT_GT(carried()[i].x, 54);
  for (int i = 9; i <= 12; ++i) EXPECT_NEAR(carried()[i].x, 10, 2);
}

TEST_P(SharedOffset, WithoutATrackerLandmarksAreWhereTheyAreSeen) {
  offsets_[kTip].x = 22;
  sigmas_[kTip] = 14;
  EXPECT_NEAR(carried(LandmarkFilter::Tracker::silent)[kTip].x, 22, 0.1);
}

TEST_P(SharedOffset, ASigmaThatIsNoneIsAsIfNoneWereSaid) {
  offsets_[kTip].x = 22;
  sigmas_.fill(0);
  const Offsets unsaid = carried();
  EXPECT_NEAR(unsaid[kTip].x, 22, 0.1);
  for (const float none : {kNan, -14.0f, -kInfinity}) {
    sigmas_.fill(none);
    EXPECT_EQ(carried(), unsaid) << none;
  }
}

TEST_P(SharedOffset, ASigmaWithoutBoundLeavesTheLandmarkToTheOthers) {
  offsets_[kTip].x = 22;
  for (const float huge : {1e30f, kInfinity}) {
    sigmas_[kTip] = huge;
    EXPECT_NEAR(carried()[kTip].x, 10, 0.1) << huge;
    sigmas_.fill(huge);
    for (const glm::vec2 offset : carried())
      EXPECT_TRUE(std::isfinite(offset.x) && std::isfinite(offset.y)) << huge;
    sigmas_.fill(2);
  }
}

class ShrinkToShared : public testing::Test {
 protected:
  ShrinkToShared() {
    for (int i = 0; i < kLandmarks; ++i) tracker_[i] = glm::vec2(300 + 7 * i, 200 + (i * i) % 31);
    offsets_.fill({10, 0});
    known_.fill(true);
    sigmas_.fill(2);
  }
  Offsets drawn() const {
    Offsets drawn = offsets_;
    shrink_to_shared(drawn, known_, sigmas_, tracker_);
    return drawn;
  }

  LandmarkPoints tracker_;
  Offsets offsets_;
  std::array<bool, kLandmarks> known_;
  Sigmas sigmas_;
};

TEST_F(ShrinkToShared, WithoutSigmasNothingMovesNotByABit) {
  for (int i = 0; i < kLandmarks; ++i)
    offsets_[i] = {0.1f * static_cast<float>(i * i), 17.3f - static_cast<float>(i)};
  sigmas_.fill(0);
  EXPECT_EQ(drawn(), offsets_);
}

TEST_F(ShrinkToShared, AHandThatTheTrackerMakesTooLargeIsMadeSmallerAtUnsureLandmarksToo) {
  for (int i = 0; i < kLandmarks; ++i)
    offsets_[i] = glm::vec2(10, 0) - 0.05f * (tracker_[i] - tracker_[0]);
  const glm::vec2 right = offsets_[20];
  offsets_[20] += glm::vec2(12, -9);
  sigmas_[20] = 40;
  EXPECT_LT(glm::distance(drawn()[20], right), 1) << "of 15 px";
}

TEST_F(ShrinkToShared, AFingerTheTrackerHasWrongHardlyMovesTheOthers) {
  for (int i = 17; i <= 20; ++i) offsets_[i].y = 20.0f * static_cast<float>(i - 17);
  sigmas_[0] = sigmas_[4] = 15;
  // By least squares, 8.7 and 3.7 px.
  EXPECT_LT(glm::distance(drawn()[0], {10, 0}), 5);
  EXPECT_LT(glm::distance(drawn()[4], {10, 0}), 2);
}

TEST_F(ShrinkToShared, OffsetsThatAreNotKnownHaveNoPartInIt) {
  offsets_[3] = {kNan, kNan};
  offsets_[4].x = 20;
  known_[3] = false;
  sigmas_[4] = 30;
  EXPECT_NEAR(drawn()[4].x, 10, 1);
  EXPECT_NEAR(drawn()[8].x, 10, 0.5);
  known_.fill(false);
  EXPECT_EQ(drawn()[8], offsets_[8]);
}

TEST_F(ShrinkToShared, LandmarksOnOneSpotAreOnlyShifted) {
  tracker_.fill({300, 200});
  sigmas_[20] = 40;
  offsets_[20].x = 22;
  EXPECT_NEAR(drawn()[20].x, 10, 1);
}

TEST(LandmarkSigmas, FollowSmoothlyWhatIsSaid) {
  LandmarkSigmas sigmas;
  msg::HandLandmarks seen;
  seen.points[kTip] = {1, 1, 1, 4};
  sigmas.detection(seen);
  EXPECT_EQ(sigmas.px()[kTip], 4) << "the first sigma is taken as it is";
  seen.points[kTip].sigma_px = 14;
  sigmas.detection(seen);
  EXPECT_LT(sigmas.px()[kTip], 6);
  for (int i = 0; i < 60; ++i) sigmas.detection(seen);
  EXPECT_NEAR(sigmas.px()[kTip], 14, 0.1);
  seen.points[kTip].confidence = 0;
  seen.points[kTip].sigma_px = 90;
  sigmas.detection(seen);
  EXPECT_NEAR(sigmas.px()[kTip], 14, 0.1) << "a landmark that is not seen keeps its sigma";
}

}  // namespace
}  // namespace handcast::renderer
