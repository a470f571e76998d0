// SPDX-License-Identifier: Apache-2.0
#include "services/projector/inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/ring/writer.hpp"
#include "services/projector/contents.hpp"
#include "services/projector/publish.hpp"
#include "services/projector/test_pictures.hpp"
#include "tests/frame_costs.hpp"

namespace handcast::projector {
namespace {

constexpr std::uint32_t kCalibration = 5;

/// Replaces the pipeline and records the ids of the messages that it gets.
struct Listener {
  void push(std::int64_t, const msg::HandPoses& message) {
    poses.push_back(message.header.frame_id);
  }
  void push(std::int64_t, const msg::Landmarks& message) {
    landmarks.push_back(message.header.frame_id);
  }

  void wear(msg::Side side, const renderer::MipView& picture) {
    worn[static_cast<std::size_t>(side)] = picture;
  }

  std::vector<std::uint64_t> poses, landmarks;
  std::array<renderer::MipView, 2> worn;
};

/// A ring with its writer and a reader.
template <class Message>
struct Ring {
  static ipc::Segment make(std::size_t payload_bytes) {
    return *ipc::Segment::create(
        ipc::RingSpec::of<Message>("ring", 16, /*keep_history=*/true, payload_bytes));
  }
  explicit Ring(std::size_t payload_bytes = sizeof(Message))
      : segment(make(payload_bytes)),
        writer(*ipc::Writer<Message>::attach(again())),
        reader(*ipc::Reader<Message>::attach(again())) {}
  ipc::Segment again() const { return *ipc::Segment::open(UniqueFd(::dup(segment.fd()))); }

  void publish(std::uint64_t id, std::uint32_t calibration = kCalibration) {
    Message message;
    message.header.frame_id = id;
    message.calibration = calibration;
    writer.publish(message);
  }
  ipc::Segment segment;
  ipc::Writer<Message> writer;
  ipc::Reader<Message> reader;
};

class InputsTest : public testing::Test {
 protected:
  void publish_image(std::uint64_t id, std::uint32_t calibration = kCalibration) {
    auto slot = frames_.writer.loan();
    slot->calibration = calibration;
    slot->header.frame_id = id;
    slot->header.origin_ns = 100 + static_cast<std::int64_t>(id);
    slot->width_px = 4;
    slot->height_px = 2;
    std::fill_n(slot->pixels(), 8, static_cast<std::uint8_t>(id));
    frames_.writer.publish(std::move(slot));
  }

  Ring<msg::CameraFrame> frames_{msg::CameraFrame::bytes(4, 2)};
  Ring<msg::HandPoses> poses_;
  Ring<msg::Landmarks> landmarks_;
  Ring<msg::ContentPicture> left_{msg::ContentPicture::bytes(8, 4)},
      right_{msg::ContentPicture::bytes(8, 4)};
  Inputs inputs_{std::move(frames_.reader), std::move(poses_.reader), std::move(landmarks_.reader),
                 Contents(std::move(left_.reader), std::move(right_.reader)), kCalibration};
  Listener pipeline_;
};

TEST_F(InputsTest, EveryPoseAndDetectionIsDeliveredOnceAndInOrder) {
  for (const std::uint64_t id : {1, 2, 3}) poses_.publish(id);
  landmarks_.publish(7);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  poses_.publish(4);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_THAT(pipeline_.poses, testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(pipeline_.landmarks, testing::ElementsAre(7));
}

TEST_F(InputsTest, OfTheImagesTheNewestIsKeptUntilANewerComes) {
  publish_image(1);
  publish_image(2);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  const auto image = inputs_.image();
  ASSERT_TRUE(image);
  EXPECT_EQ(image.id, 2u);
  EXPECT_EQ(image.origin_ns, 102);
  EXPECT_EQ(image.view.width, 4);
  EXPECT_EQ(image.view.height, 2);
  EXPECT_EQ(image.view.at(3, 1), 2);
}

TEST_F(InputsTest, WhatBelongsToAnotherCalibrationIsLeftOutAndReported) {
  poses_.publish(1, 6);
  poses_.publish(2, 0);  // a tracker's poses depend on no calibration
  landmarks_.publish(3, 6);
  landmarks_.publish(4);
  publish_image(5, 6);
  const auto delivered = inputs_.deliver(pipeline_, Deadline::now());
  ASSERT_FALSE(delivered);
  EXPECT_EQ(delivered.error().code, Errc::bad_data);
  EXPECT_THAT(delivered.error().what, testing::HasSubstr("another calibration"));
  EXPECT_THAT(pipeline_.poses, testing::ElementsAre(2));
  EXPECT_THAT(pipeline_.landmarks, testing::ElementsAre(4));
  EXPECT_FALSE(inputs_.image());
  publish_image(6);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_TRUE(inputs_.image());
}

void publish_content(ipc::Writer<msg::ContentPicture>& writer, std::uint32_t colour,
                     std::uint32_t width_px = 8) {
  auto slot = writer.loan();
  slot->width_px = width_px;
  slot->height_px = 4;
  if (width_px == 8) {
    const renderer::Texture picture(8, 4, colour);
    renderer::write_mips(picture.view(), slot->mip_layout(), slot->texels());
  }
  writer.publish(std::move(slot));
}

TEST_F(InputsTest, EachHandWearsItsNewestContentWhereItWasWritten) {
  publish_content(left_.writer, 0xff000001);
  publish_content(left_.writer, 0xff000002);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  const auto worn = pipeline_.worn;
  ASSERT_NE(worn[0].texels, nullptr);
  EXPECT_EQ(worn[0].layout.width, 8);
  EXPECT_EQ(worn[0].all().at(1, 1), 0xff000002u);
  EXPECT_EQ(worn[1].texels, nullptr);
  // A writer that goes on does not touch what is worn.
  for (std::uint32_t colour = 3; colour < 40; ++colour) publish_content(left_.writer, colour);
  EXPECT_EQ(worn[0].all().at(1, 1), 0xff000002u);
  publish_content(right_.writer, 0xff000050);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_EQ(pipeline_.worn[0].all().at(8, 4), 39u);
  EXPECT_EQ(pipeline_.worn[1].all().at(1, 1), 0xff000050u);
}

TEST_F(InputsTest, ContentOfAnImpossibleSizeLeavesTheOneBefore) {
  publish_content(left_.writer, 0xff000001);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  const auto worn = pipeline_.worn[0];
  for (const std::uint32_t width_px : {0u, 9u, 2048u, 2049u, ~0u}) {
    publish_content(left_.writer, 0, width_px);
    (void)inputs_.deliver(pipeline_, Deadline::now());
    EXPECT_EQ(pipeline_.worn[0].texels, worn.texels) << width_px;
  }
  publish_content(left_.writer, 0xff000002);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_EQ(pipeline_.worn[0].all().at(1, 1), 0xff000002u);
}

/// Replaces the pipeline and keeps nothing.
struct Sink {
  void push(std::int64_t, const msg::HandPoses&) { ++messages; }
  void push(std::int64_t, const msg::Landmarks&) { ++messages; }
  void wear(msg::Side, const renderer::MipView&) { ++messages; }
  int messages = 0;
};

TEST_F(InputsTest, WithAndWithoutNewsAFrameAllocatesAndLocksNothing) {
  if (!test::are_costs_counted()) GTEST_SKIP() << "sanitizers allocate memory of their own";
  Ring<msg::TestPicture> picture_ring(msg::TestPicture::bytes(4, 2));
  TestPictures test_pictures(std::move(picture_ring.reader), 4, 2);
  Ring<msg::Projection> projections(msg::Projection::bytes(4, 2));
  const std::array<msg::StageMark, 3> stages{};
  Sink sink;
  const auto frame = [&](std::uint64_t id) {
    EXPECT_TRUE(inputs_.deliver(sink, Deadline::now()));
    EXPECT_EQ(test_pictures.at(now_ns(), now_ns()), nullptr);
    renderer::Frame drawn;
    publish_projection(drawn, id, {}, projections.writer);
    return std::span<const msg::StageMark>(TimeSheet(stages, {.display_ns = 5})).size();
  };
  for (std::uint64_t id = 1; id <= 20; ++id) {
    if (id % 2 == 0) publish_image(id);
    if (id % 3 == 0) poses_.publish(id);
    if (id % 4 == 0) landmarks_.publish(id);
    if (id % 5 == 0) publish_content(left_.writer, 0xff000000);
    const auto before = test::frame_costs();
    EXPECT_EQ(frame(id), 5u);
    const auto costs = test::frame_costs() - before;
    if (id <= 4) continue;  // the buffers of the readers
    EXPECT_EQ(costs.allocations, 0u) << "frame " << id;
    EXPECT_EQ(costs.locks, 0u) << "frame " << id;
  }
  EXPECT_EQ(sink.messages, 6 + 5 + 4);
}

TEST_F(InputsTest, AnImageOfTheOldCalibrationIsNotKeptWhenTheNewOneComes) {
  publish_image(1);
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  publish_image(2, 6);
  ASSERT_FALSE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_FALSE(inputs_.image());
}

TEST_F(InputsTest, WithoutAnySensorThereIsNoImageAndNoError) {
  ASSERT_TRUE(inputs_.deliver(pipeline_, Deadline::now()));
  EXPECT_FALSE(inputs_.image());
  EXPECT_THAT(pipeline_.poses, testing::IsEmpty());
}

}  // namespace
}  // namespace handcast::projector
