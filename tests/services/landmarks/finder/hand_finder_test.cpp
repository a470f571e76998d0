// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/hand_finder.hpp"

#include <gmock/gmock.h>

#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

/// Records its arguments and always estimates a hand: `found_px`, or, if it is empty, all points 10
/// px right of the region's centre.
class RecordingModel final : public LandmarkModel {
 public:
  struct Call {
    Region region;
    msg::Side side;
    std::optional<Points> tracker_px;
  };
  explicit RecordingModel(std::vector<Call>& calls, std::optional<Points> found_px = {})
      : calls_(calls), found_px_(found_px) {}
  Traits traits() const override { return {.passes_at_first = 2, .reads_tracker = true}; }
  Region region_around(const Points& points_px) const override {
    return {centre_of(points_px), 100, 0};
  }
  Result<LandmarkEstimate> estimate(renderer::GreyView, const Region& region, msg::Side side,
                                    const std::optional<Points>& tracker_px,
                                    EstimateTimes&) override {
    calls_.push_back({region, side, tracker_px});
    LandmarkEstimate estimate{.presence = 1};
    estimate.points_px.fill(region.centre_px + glm::vec2(10, 0));
    if (found_px_) estimate.points_px = *found_px_;
    return estimate;
  }

 private:
  std::vector<Call>& calls_;
  std::optional<Points> found_px_;
};

TEST(HandFinder, GivesTheModelEachHandsSideAndItsJointsOfTheTracker) {
  std::vector<RecordingModel::Call> calls;
  HandFinder finder({std::make_unique<RecordingModel>(calls), std::nullopt}, 2);
  const test::Grey image(720, 540, 0);
  Points left_px, right_px;
  left_px.fill({200, 300});
  right_px.fill({500, 300});
  ASSERT_TRUE(finder.find(image.view(), {left_px, right_px}, 1));
  ASSERT_EQ(calls.size(), 4u) << "twice a hand";
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(calls[i].side, i < 2 ? msg::Side::left : msg::Side::right);
    EXPECT_EQ(calls[i].tracker_px, i < 2 ? left_px : right_px);
    EXPECT_EQ(calls[i].region.centre_px.x, (i < 2 ? 200 : 500) + (i % 2 ? 10 : 0));
  }
  calls.clear();
  ASSERT_TRUE(finder.find(image.view(), {std::nullopt, right_px}, 2));
  ASSERT_EQ(calls.size(), 2u) << "once a hand that is followed";
  for (const auto& call : calls)
    EXPECT_EQ(call.tracker_px.has_value(), call.side == msg::Side::right);
}

TEST(HandFinder, AJointThatTremblesOverARestingHandIsSteadyForTheModel) {
  Points hand_px;
  for (std::size_t i = 0; i < hand_px.size(); ++i)
    hand_px[i] = {300 + 10 * static_cast<float>(i % 5), 300 - 10 * static_cast<float>(i)};
  std::vector<RecordingModel::Call> calls;
  HandFinder finder({std::make_unique<RecordingModel>(calls, hand_px), std::nullopt}, 1);
  const test::Grey image(720, 540, 0);
  Points trembled_px = hand_px;
  trembled_px[8].x += 8;
  for (int i = 0; i <= 200; ++i)
    ASSERT_TRUE(
        finder.find(image.view(), {i < 200 ? hand_px : trembled_px, std::nullopt}, i * 5'000'000));
  calls.clear();
  ASSERT_TRUE(finder.find(image.view(), {trembled_px, std::nullopt}, 201 * 5'000'000));
  ASSERT_EQ(calls.size(), 1u);
  ASSERT_TRUE(calls[0].tracker_px);
  EXPECT_NEAR((*calls[0].tracker_px)[8].x, hand_px[8].x, 0.2f);
}

/// Reads one open hand at a fixed place, its thumb on the side of which it was asked for a hand.
class TwoSidedModel final : public LandmarkModel {
 public:
  Traits traits() const override { return {.passes_at_first = 1}; }
  Region region_around(const Points& points_px) const override {
    return {centre_of(points_px), 200, 0};
  }
  Result<LandmarkEstimate> estimate(renderer::GreyView, const Region&, msg::Side side,
                                    const std::optional<Points>&, EstimateTimes&) override {
    const float to_thumb_px = side == msg::Side::left ? 30 : -30;
    LandmarkEstimate estimate{.presence = 1};
    estimate.points_px[0] = {300, 400};
    for (int i = 1; i < msg::kLandmarks; ++i) {
      const int finger = (i - 1) / 4, joint = (i - 1) % 4;
      estimate.points_px[i] = {300 + to_thumb_px * static_cast<float>(2 - finger),
                               300 - 25 * static_cast<float>(joint)};
    }
    return estimate;
  }
};

/// The sides that are found once the tracker, which had a left and a right hand at one place, has
/// these.
std::vector<msg::Side> sides_found(const Hints& hints_px, const Points& both_px) {
  HandFinder finder({std::make_unique<TwoSidedModel>(), std::nullopt}, 2);
  const test::Grey image(720, 540, 0);
  EXPECT_TRUE(finder.find(image.view(), {both_px, both_px}, 1));
  const auto found = finder.find(image.view(), hints_px, 2);
  EXPECT_TRUE(found);
  std::vector<msg::Side> sides;
  for (const auto& hand : *found) sides.push_back(hand.side);
  return sides;
}

TEST(HandFinder, AHandThatIsReadAsALeftAndARightOneIsOneUnlessTheTrackerHasBoth) {
  using enum msg::Side;
  Points hand_px;
  hand_px.fill({300, 300});
  EXPECT_THAT(sides_found({hand_px, hand_px}, hand_px), testing::ElementsAre(left, right));
  EXPECT_THAT(sides_found({hand_px, std::nullopt}, hand_px), testing::ElementsAre(left));
  EXPECT_THAT(sides_found({std::nullopt, hand_px}, hand_px), testing::ElementsAre(right));
  EXPECT_EQ(sides_found({std::nullopt, std::nullopt}, hand_px).size(), 1u);
}

}  // namespace
}  // namespace handcast::landmarks
