// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/hand_finder.hpp"

#include <gtest/gtest.h>

#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

/// Records its arguments and always estimates a hand, 10 px right of the region's centre.
class RecordingModel final : public LandmarkModel {
 public:
  struct Call {
    Region region;
    msg::Side side;
    std::optional<Points> tracker_px;
  };
  explicit RecordingModel(std::vector<Call>& calls) : calls_(calls) {}
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
    return estimate;
  }

 private:
  std::vector<Call>& calls_;
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

}  // namespace
}  // namespace handcast::landmarks
