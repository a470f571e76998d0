// SPDX-License-Identifier: Apache-2.0
#include "services/projector/sub_frame_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/ring/reader.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::projector {
namespace {

/// 4 sub-frames of 5 ms.
config::Projector settings() {
  config::Projector projector;
  projector.packing = config::Packing::quadrants_4;
  projector.rate_hz = 200;
  return projector;
}

class SubFrameMessagesTest : public testing::Test {
 protected:
  ipc::Segment ring() const { return *ipc::Segment::open(UniqueFd(::dup(segment_.fd()))); }

  /// Keeps a drawing of one pixel.
  void draw(std::uint32_t colour, std::int64_t target_ns, int count) {
    renderer::Texture pixels(4, 4, colour);
    renderer::Frame frame;
    frame.colour = pixels.view();
    frame.region = {1, 2, 2, 3};
    frame.target_ns = target_ns;
    const msg::StageMark mark{msg::Stage::frame, 0, target_ns - 9 * kMs, target_ns - 8 * kMs};
    frame.stages = {&mark, 1};
    messages_.keep(frame, count);
  }

  /// The message that is published next, as frame_id, pixel, target_ns, display_ns.
  using Seen = std::tuple<std::uint64_t, std::uint32_t, std::int64_t, std::int64_t>;
  std::vector<Seen> seen() {
    std::vector<Seen> all;
    while (const auto message = reader_.next(Deadline::now()))
      all.emplace_back((*message)->header.frame_id, (*message)->pixels()[0], (*message)->target_ns,
                       (*message)->lit_ns);
    return all;
  }

  ipc::Segment segment_ = *ipc::Segment::create(ipc::RingSpec::of<msg::Projection>(
      "projection.frames", 16, /*keep_history=*/true, msg::Projection::bytes(4, 4)));
  ipc::Reader<msg::Projection> reader_ = *ipc::Reader<msg::Projection>::attach(ring());
  std::vector<std::uint64_t> marked_;
  SubFramePlan plan_{settings()};
  SubFrameMessages messages_{
      *ipc::Writer<msg::Projection>::attach(ring()),
      [this](const msg::Header& header, auto, const auto&) { marked_.push_back(header.frame_id); }};
};

TEST_F(SubFrameMessagesTest, EachSubFrameHasAMessageWithItsOwnTargetAndLight) {
  for (std::uint32_t k = 0; k < 4; ++k) draw(k, 50 + k, 1);
  EXPECT_THAT(seen(), testing::IsEmpty()) << "the time of the light is not yet known";
  messages_.handed_over(plan_, 40, {100 * kMs, 113 * kMs});
  messages_.publish(1000 * kMs);
  EXPECT_THAT(seen(),
              testing::ElementsAre(Seen{40, 0, 50, 105'500'000}, Seen{41, 1, 51, 110'500'000},
                                   Seen{42, 2, 52, 115'500'000}, Seen{43, 3, 53, 120'500'000}));
  EXPECT_THAT(marked_, testing::ElementsAre(40, 41, 42, 43));
}

TEST_F(SubFrameMessagesTest, TheMessagesComeAtTheRateOfTheLight) {
  for (std::uint32_t k = 0; k < 4; ++k) draw(k, 50, 1);
  messages_.handed_over(plan_, 0, {100 * kMs, 113 * kMs});
  EXPECT_EQ(messages_.due_ns(), 100 * kMs);
  messages_.publish(100 * kMs);
  EXPECT_EQ(seen().size(), 1u);
  EXPECT_EQ(messages_.due_ns(), 105 * kMs);
  messages_.publish(110 * kMs);
  EXPECT_EQ(seen().size(), 2u);
}

TEST_F(SubFrameMessagesTest, ADrawingInSeveralSubFramesIsJudgedInEachAndMarkedOnce) {
  draw(7, 50, 1);
  draw(8, 60, 2);
  messages_.extend(1);
  messages_.handed_over(plan_, 4, {100 * kMs, 113 * kMs});
  messages_.publish(1000 * kMs);
  EXPECT_THAT(seen(),
              testing::ElementsAre(Seen{4, 7, 50, 105'500'000}, Seen{5, 8, 60, 110'500'000},
                                   Seen{6, 8, 60, 115'500'000}, Seen{7, 8, 60, 120'500'000}));
  EXPECT_THAT(marked_, testing::ElementsAre(4, 5)) << "the others count as missed";
}

TEST_F(SubFrameMessagesTest, NoMessageIsLostIfTheNextOutputFrameIsHandedOverEarly) {
  draw(1, 50, 4);
  messages_.handed_over(plan_, 0, {100 * kMs, 113 * kMs});
  draw(2, 60, 4);
  messages_.handed_over(plan_, 4, {101 * kMs, 114 * kMs});
  EXPECT_EQ(seen().size(), 4u);
  messages_.publish(1000 * kMs);
  EXPECT_EQ(seen().size(), 4u);
}

TEST_F(SubFrameMessagesTest, AnOutputFrameThatWasNotShownIsNotPublished) {
  draw(1, 50, 4);
  messages_.drop();
  draw(2, 60, 4);
  messages_.handed_over(plan_, 4, {100 * kMs, 113 * kMs});
  messages_.publish(1000 * kMs);
  for (const auto& [id, pixel, target_ns, display_ns] : seen()) EXPECT_EQ(pixel, 2u);
}

}  // namespace
}  // namespace handcast::projector
