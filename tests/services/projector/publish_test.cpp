// SPDX-License-Identifier: Apache-2.0
#include "services/projector/publish.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace handcast::projector {
namespace {

class WriteProjection : public testing::Test {
 protected:
  WriteProjection() : memory_(msg::Projection::bytes(8, 6) / sizeof(std::uint64_t) + 1) {
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) pixels_.at(x, y) = static_cast<std::uint32_t>(10 * y + x);
    frame_.target_ns = 77;
    frame_.made_from = {.image_id = 4, .image_ns = 6, .pose_ns = 7, .landmarks_ns = 3};
    frame_.colour = pixels_.view();
    frame_.region = {2, 1, 5, 4};
    hand_.side = renderer::Side::right;
    hand_.projected_px = vertices_;
    frame_.hands = {&hand_, 1};
    frame_.foldovers = 3;
  }
  msg::Projection& write(std::size_t tail_bytes) {
    auto& projection = *new (memory_.data()) msg::Projection;
    write_projection(frame_, 5, PresentTimes{80, 90}, projection, tail_bytes);
    return projection;
  }

  /// The room that a region of 3 x 3 pixels needs.
  static constexpr std::size_t kTail = msg::Projection::bytes(3, 3) - sizeof(msg::Projection);
  renderer::Image<std::uint32_t> pixels_{8, 6};
  std::vector<glm::vec2> vertices_{{1, 2}, {3, 4}};
  renderer::FrameHand hand_;
  renderer::Frame frame_;
  std::vector<std::uint64_t> memory_;
};

TEST_F(WriteProjection, HoldsTheRegionRowByRowWithoutPadding) {
  const auto& projection = write(8 * 6 * 4);
  EXPECT_EQ(projection.region_x_px, 2);
  EXPECT_EQ(projection.region_y_px, 1);
  ASSERT_EQ(projection.region_width_px, 3u);
  ASSERT_EQ(projection.region_height_px, 3u);
  const std::vector<std::uint32_t> copied(projection.pixels(), projection.pixels() + 9);
  EXPECT_EQ(copied, (std::vector<std::uint32_t>{12, 13, 14, 22, 23, 24, 32, 33, 34}));
}

TEST_F(WriteProjection, CarriesItsOwnNumberItsOriginsItsTimesAndItsLandings) {
  const auto& projection = write(8 * 6 * 4);
  EXPECT_EQ(projection.header.frame_id, 5u);
  EXPECT_EQ(projection.header.origin_ns, 6);
  EXPECT_EQ(projection.made_from.image_id, 4u);
  EXPECT_EQ(projection.made_from.image_ns, 6);
  EXPECT_EQ(projection.made_from.pose_ns, 7);
  EXPECT_EQ(projection.made_from.landmarks_ns, 3);
  EXPECT_EQ(projection.target_ns, 77);
  EXPECT_EQ(projection.lit_ns, 90);
  EXPECT_EQ(projection.width_px, 8u);
  EXPECT_EQ(projection.foldovers, 3u);
  ASSERT_EQ(projection.hand_count, 1u);
  EXPECT_EQ(projection.hands[0].side, msg::Side::right);
  ASSERT_EQ(projection.hands[0].vertex_count, 2u);
  EXPECT_EQ(projection.hands[0].landings[1].y_px, 4);
}

TEST_F(WriteProjection, ARegionThatDoesNotFitIsLeftOutNotOverrun) {
  const auto& projection = write(kTail - 1);
  EXPECT_EQ(projection.region_width_px, 0u);
  EXPECT_EQ(projection.used_bytes(), sizeof(msg::Projection));
}

TEST_F(WriteProjection, ARegionThatJustFitsIsWrittenAndNothingBeyondIt) {
  std::fill(memory_.begin(), memory_.end(), 0xa5a5a5a5a5a5a5a5u);
  const auto& projection = write(kTail);
  ASSERT_EQ(projection.region_width_px * projection.region_height_px, 9u);
  EXPECT_EQ(projection.pixels()[8], 34u);
  EXPECT_EQ(projection.pixels()[9], 0xa5a5a5a5u);
}

TEST_F(WriteProjection, SaysWhatEveryFourthPixelShowsAndOnWhichHand) {
  renderer::Image<glm::vec2> uv(8, 6);
  renderer::Image<renderer::SurfaceId> surface(8, 6);
  EXPECT_EQ(write(8 * 6 * 6).has_shown, 0u) << "nobody asked what is shown";
  // The first hand of the frame is not drawn, so the second one is the first in the drawing.
  std::array<renderer::FrameHand, 2> hands;
  hands[1].drawn_as = 0;
  frame_.hands = hands;
  frame_.region = {3, 0, 8, 5};
  frame_.uv = uv.view();
  frame_.surface = surface.view();
  uv.at(4, 0) = {0.5f, 1.0f};
  surface.at(4, 0) = renderer::surface_id(0, 7);
  uv.at(4, 4) = {-0.2f, 3};
  surface.at(4, 4) = renderer::surface_id(0, 1);
  const auto& projection = write(8 * 6 * 6);
  ASSERT_EQ(projection.has_shown, 1u);
  EXPECT_EQ(projection.shown(4, 0).u, 32768);
  EXPECT_EQ(projection.shown(4, 0).v, 65535);
  EXPECT_EQ(projection.shown(4, 0).hand, 2);
  EXPECT_EQ(projection.shown(4, 4).u, 0);
  EXPECT_EQ(projection.shown(4, 4).v, 65535);
  surface.at(4, 4) = 0;
  EXPECT_EQ(write(8 * 6 * 6).shown(4, 4).hand, 0) << "dark";
}

TEST_F(WriteProjection, LandingsAndHandsBeyondTheMessagesRoomAreLeftOut) {
  vertices_.assign(msg::kMaxVertices + 50, {7, 8});
  vertices_.back() = {-1, -1};
  hand_.projected_px = vertices_;
  const std::vector<renderer::FrameHand> many(msg::kMaxHands + 2, hand_);
  frame_.hands = many;
  const auto& projection = write(8 * 6 * 4);
  ASSERT_EQ(projection.hand_count, static_cast<std::uint32_t>(msg::kMaxHands));
  for (const auto& hand : projection.hands) {
    ASSERT_EQ(hand.vertex_count, static_cast<std::uint32_t>(msg::kMaxVertices));
    EXPECT_EQ(hand.landings.back().x_px, 7);
  }
  EXPECT_EQ(projection.pixels()[0], 12u);
}

TEST_F(WriteProjection, ADarkFrameHasNoRegion) {
  frame_.region = {};
  frame_.hands = {};
  const auto& projection = write(8 * 6 * 4);
  EXPECT_EQ(projection.region_width_px * projection.region_height_px, 0u);
  EXPECT_EQ(projection.hand_count, 0u);
}

}  // namespace
}  // namespace handcast::projector
