// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/sequence/sequence.hpp"

#include <gmock/gmock.h>

#include <set>

#include "config/sections/sub_frames.hpp"
#include "renderer/output/packing.hpp"
#include "services/projector/dlp/sequence/encode.hpp"

namespace handcast::dlp {
namespace {

using config::Packing;
using protocol::Bytes;
using protocol::Command;
using protocol::Controller;
using testing::HasSubstr;

constexpr std::uint8_t kWhite = protocol::kRed | protocol::kGreen | protocol::kBlue;

config::Projector projector_of(Packing packing, double output_hz) {
  config::Projector projector;
  projector.packing = packing;
  projector.rate_hz = output_hz * config::sub_frames_of(packing);
  projector.brightness = 1;
  projector.dither = false;
  return projector;
}

/// The numbers of the bits that a sub-frame of white light sets, in a pattern's numbering.
std::set<int> bits_of_sub_frame(const config::Projector& projector, int sub_frame) {
  const auto packer = renderer::make_packer(projector, 64, 8);
  std::vector<std::uint32_t> white(64 * 8, 0xffffffffu);
  packer->begin(1);
  packer->add({white.data(), 64, 8}, {0, 0, 64, 8}, sub_frame, 1);
  const auto pixel = *packer->image().row(4);
  std::set<int> bits;
  for (int bit = 0; bit < 8; ++bit) {
    if (pixel >> (8 + bit) & 1) bits.insert(bit);        // green
    if (pixel >> bit & 1) bits.insert(8 + bit);          // red
    if (pixel >> (16 + bit) & 1) bits.insert(16 + bit);  // blue
  }
  return bits;
}

class SequenceOfPacking : public testing::TestWithParam<Packing> {};

TEST_P(SequenceOfPacking, ShowsTheBitsInTheOrderInWhichTheRendererFillsThem) {
  const auto projector = projector_of(GetParam(), 60);
  const auto sequence = make_sequence(Controller::dlpc350, projector, kWhite);
  ASSERT_TRUE(sequence) << sequence.error().what;
  std::vector<std::set<int>> shown;
  for (const auto& pattern : sequence->patterns) {
    if (pattern.begins_sub_frame) shown.emplace_back();
    shown.back().insert(pattern.bit);
  }
  ASSERT_EQ(shown.size(), static_cast<std::size_t>(config::sub_frames_of(GetParam())));
  for (std::size_t i = 0; i < shown.size(); ++i)
    EXPECT_EQ(shown[i], bits_of_sub_frame(projector, static_cast<int>(i))) << "sub-frame " << i;
}

INSTANTIATE_TEST_SUITE_P(All, SequenceOfPacking,
                         testing::Values(Packing::planes_24x1, Packing::planes_8x3));

TEST(Sequence, LightsEachColourByItsOwnLed) {
  const auto sequence =
      make_sequence(Controller::dlpc350, projector_of(Packing::planes_8x3, 60), kWhite);
  ASSERT_TRUE(sequence);
  for (const auto& pattern : sequence->patterns)
    EXPECT_EQ(pattern.leds, pattern.bit < 8    ? protocol::kGreen
                            : pattern.bit < 16 ? protocol::kRed
                                               : protocol::kBlue);
}

TEST(Sequence, EndsBeforeTheNextOutputFrame) {
  for (const double output_hz : {24.0, 60.0, 120.0})
    for (const auto packing : {Packing::planes_24x1, Packing::planes_8x3}) {
      const auto sequence =
          make_sequence(Controller::dlpc350, projector_of(packing, output_hz), kWhite);
      ASSERT_TRUE(sequence);
      const double share = 24 * sequence->exposure_us * output_hz / 1e6;
      EXPECT_LT(share, 0.9951);
      EXPECT_GT(share, 0.98);
    }
}

TEST(Sequence, APatternThatIsTooShortIsRefusedWithTheHighestRate) {
  const auto projector = projector_of(Packing::planes_24x1, 200);
  const auto sequence = make_sequence(Controller::dlpc350, projector, kWhite);
  ASSERT_FALSE(sequence);
  EXPECT_EQ(sequence.error().code, Errc::bad_config);
  EXPECT_THAT(sequence.error().what, HasSubstr("235 µs"));
  EXPECT_THAT(sequence.error().what, HasSubstr("at most 4234"));
  EXPECT_TRUE(make_sequence(Controller::dlpc900, projector, kWhite));
  auto at_most = projector;
  at_most.rate_hz = 4234;
  EXPECT_TRUE(make_sequence(Controller::dlpc350, at_most, kWhite));
}

TEST(Sequence, APackingWithoutBitsIsRefusedWithTheRemedy) {
  for (const auto packing : {Packing::none, Packing::quadrants_4, Packing::quadrants_12}) {
    const auto sequence = make_sequence(Controller::dlpc900, projector_of(packing, 60), kWhite);
    ASSERT_FALSE(sequence);
    EXPECT_EQ(sequence.error().code, Errc::bad_config);
    EXPECT_THAT(sequence.error().what, HasSubstr("projector.packing"));
  }
}

TEST(Exposure, HasALeastTimeForEachDepth) {
  EXPECT_EQ(least_exposure_us(Controller::dlpc350, 1), 235);
  EXPECT_EQ(least_exposure_us(Controller::dlpc350, 8), 8333);
  EXPECT_EQ(least_exposure_us(Controller::dlpc900, 1), 105);
  EXPECT_EQ(least_exposure_us(Controller::dlpc350, 0), std::nullopt);
  EXPECT_EQ(least_exposure_us(Controller::dlpc350, 9), std::nullopt);
}

Bytes data_of(const std::vector<Setting>& settings, Command command) {
  for (const auto& setting : settings)
    if (setting.command == command) return setting.data;
  return {};
}

Sequence two_patterns() {
  return {.patterns = {{.bit = 3, .leds = protocol::kGreen},
                       {.bit = 23, .leds = kWhite, .begins_sub_frame = false}},
          .exposure_us = 0x0102};
}

TEST(SequenceForDlpc350, IsEncodedByteForByte) {
  const auto settings = encode_for_dlpc350(two_patterns(), {});
  EXPECT_EQ(data_of(settings, Command::pattern_definition),
            (Bytes{1 | 3 << 2, 1 | 2 << 4, 0, 3 | 23 << 2, 1 | 7 << 4, 0}));
  EXPECT_EQ(data_of(settings, Command::pattern_period), (Bytes{2, 1, 0, 0, 2, 1, 0, 0}));
  EXPECT_EQ(data_of(settings, Command::pattern_count), (Bytes{1, 1, 1, 0}));
  EXPECT_EQ(data_of(settings, Command::trigger_mode), Bytes{protocol::kVerticalSync});
  EXPECT_EQ(data_of(settings, Command::trigger_out_1), Bytes{});
  EXPECT_EQ(settings.back().command, Command::mailbox);
  EXPECT_EQ(settings.back().data, Bytes{0});
}

TEST(SequenceForDlpc350, AnExternalTriggerStartsEachSubFrame) {
  auto sequence = two_patterns();
  sequence.patterns.push_back({.bit = 4, .leds = protocol::kGreen});
  const auto settings = encode_for_dlpc350(sequence, {.in = true, .out = true});
  const auto table = data_of(settings, Command::pattern_definition);
  ASSERT_EQ(table.size(), 9u);
  EXPECT_EQ(table[0] & 3, 1);
  EXPECT_EQ(table[3] & 3, 3);
  EXPECT_EQ(table[6] & 3, 1);
  EXPECT_EQ(data_of(settings, Command::trigger_mode), Bytes{protocol::kExternalTrigger});
  EXPECT_EQ(data_of(settings, Command::trigger_out_1), (Bytes{0, 0xbb, 0xbb}));
}

TEST(SequenceForDlpc900, IsEncodedByteForByte) {
  const auto settings = encode_for_dlpc900(two_patterns(), {.out = true});
  std::vector<Bytes> definitions;
  for (const auto& setting : settings)
    if (setting.command == Command::pattern_definition) definitions.push_back(setting.data);
  ASSERT_EQ(definitions.size(), 2u);
  // Index, exposure, trigger and LEDs, dark time, no second trigger, bit.
  EXPECT_EQ(definitions[0], (Bytes{0, 0, 2, 1, 0, 0x80 | 2 << 4, 0, 0, 0, 0, 0, 3 << 3}));
  EXPECT_EQ(definitions[1], (Bytes{1, 0, 2, 1, 0, 7 << 4, 0, 0, 0, 1, 0, 23 << 3}));
  EXPECT_EQ(settings.back().command, Command::pattern_count);
  EXPECT_EQ(settings.back().data, (Bytes{2, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace handcast::dlp
