// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "services/projector/dlp/protocol/payload.hpp"

namespace handcast::dlp::protocol {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

Bytes start_of(const Report& report, std::size_t count) {
  return {report.begin(), report.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// A report that begins with these bytes.
Report report_of(const Bytes& bytes) {
  Report report{};
  std::copy(bytes.begin(), bytes.end(), report.begin());
  return report;
}

TEST(Message, AReadAsTheManualShowsIt) {
  const auto reports = encode(static_cast<Command>(0x1100), Direction::read, 0x11);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(start_of(reports[0], 6), (Bytes{0xc0, 0x11, 0x02, 0x00, 0x00, 0x11}));
  EXPECT_THAT(Bytes(reports[0].begin() + 6, reports[0].end()), Each(0));
}

TEST(Message, AWriteAsksForAReply) {
  const auto reports = encode(Command::led_currents, Direction::write, 0x12, Bytes{1, 2, 3});
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(start_of(reports[0], 9), (Bytes{0x40, 0x12, 0x05, 0x00, 0x01, 0x0b, 1, 2, 3}));
}

TEST(Message, ALongOneGoesOnWithoutAHeader) {
  Bytes data(72);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i + 1);
  const auto reports = encode(Command::pattern_definition, Direction::write, 7, data);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(start_of(reports[0], 7), (Bytes{0x40, 7, 74, 0, 0x34, 0x1a, 1}));
  EXPECT_EQ(reports[0].back(), 58);
  EXPECT_EQ(start_of(reports[1], 15),
            (Bytes{59, 60, 61, 62, 63, 64, 65, 66, 67, 68, 69, 70, 71, 72, 0}));
}

TEST(Reply, IsTakenWhole) {
  ReplyReader reader(9);
  const auto reply = reader.take(report_of({0x80, 9, 3, 0, 5, 6, 7}));
  ASSERT_TRUE(reply && *reply);
  EXPECT_FALSE((*reply)->refused);
  EXPECT_THAT((*reply)->data, ElementsAre(5, 6, 7));
}

TEST(Reply, OfSeveralReportsIsPutTogether) {
  ReplyReader reader(9);
  Report first = report_of({0x80, 9, 62, 0});
  std::fill(first.begin() + 4, first.end(), std::uint8_t{1});
  auto reply = reader.take(first);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(*reply);
  reply = reader.take(report_of({2, 2, 99}));
  ASSERT_TRUE(reply && *reply);
  EXPECT_EQ((*reply)->data.size(), 62u);
  EXPECT_EQ((*reply)->data.back(), 2);
}

TEST(Reply, WithTheErrorBitIsARefusal) {
  ReplyReader reader(9);
  const auto reply = reader.take(report_of({0x20, 9, 0, 0}));
  ASSERT_TRUE(reply && *reply);
  EXPECT_TRUE((*reply)->refused);
}

TEST(Reply, ToAnotherMessageIsPassedOverWithAllItsReports) {
  ReplyReader reader(9);
  auto reply = reader.take(report_of({0x80, 8, 70, 0}));
  ASSERT_TRUE(reply);
  EXPECT_FALSE(*reply);
  reply =
      reader.take(report_of({0x80, 9, 1, 0, 1}));  // looks like a reply, is the rest of the other
  ASSERT_TRUE(reply);
  EXPECT_FALSE(*reply);
  reply = reader.take(report_of({0x80, 9, 1, 0, 42}));
  ASSERT_TRUE(reply && *reply);
  EXPECT_THAT((*reply)->data, ElementsAre(42));
  EXPECT_EQ(reader.strays(), 1);
}

TEST(Reply, ThatIsCutOrAbsurdIsBadDataNotAHang) {
  for (const Bytes& damaged : {Bytes{0x80, 9, 1}, Bytes{0x80, 9, 40, 0, 1, 2}, Bytes{}}) {
    ReplyReader reader(9);
    const auto reply = reader.take(damaged);
    ASSERT_FALSE(reply);
    EXPECT_EQ(reply.error().code, Errc::bad_data);
  }
  ReplyReader reader(9);
  const auto reply = reader.take(report_of({0x80, 9, 0xff, 0xff}));
  ASSERT_FALSE(reply);
  EXPECT_THAT(reply.error().what, HasSubstr("65535"));
}

TEST(Currents, NeverExceedTheLimit) {
  const Currents currents{.red = 1, .green = 0.25, .blue = 0};
  EXPECT_THAT(encode_currents(false, currents, 0.5), ElementsAre(127, 63, 0));
  // The drivers of the LightCrafter 4500 are inverted: 255 is dark.
  EXPECT_THAT(encode_currents(true, currents, 0.5), ElementsAre(128, 192, 255));
  EXPECT_THAT(encode_currents(true, currents, 0), Each(255));
}

TEST(Currents, AreInvertedAsTheBoardOrTheUserSays) {
  using config::LedSignal;
  EXPECT_TRUE(is_inverted(LedSignal::automatic, Controller::dlpc350));
  EXPECT_FALSE(is_inverted(LedSignal::automatic, Controller::dlpc900));
  for (const auto controller : {Controller::dlpc350, Controller::dlpc900}) {
    EXPECT_TRUE(is_inverted(LedSignal::inverted, controller));
    EXPECT_FALSE(is_inverted(LedSignal::direct, controller));
  }
}

TEST(Currents, EnableOnlyTheLedsThatHaveOne) {
  EXPECT_EQ(enables_of({.red = 0.1, .blue = 0.2}), kRed | kBlue | kSequencer);
  EXPECT_EQ(enables_of({}), 0);
}

TEST(Version, IsThatOfTheApplication) {
  EXPECT_EQ(decode_version(Bytes{2, 1, 3, 4, 9, 9}).value(), "4.3.258");
  EXPECT_FALSE(decode_version(Bytes{1, 2, 3}));
}

TEST(ErrorCode, EachHasASentence) {
  EXPECT_THAT(explain_error_code(5), HasSubstr("not allowed in the present mode"));
  EXPECT_THAT(explain_error_code(255), HasSubstr("internal"));
  EXPECT_THAT(explain_error_code(99), HasSubstr("99"));
}

}  // namespace
}  // namespace handcast::dlp::protocol
