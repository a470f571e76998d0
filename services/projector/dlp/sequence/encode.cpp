// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/sequence/encode.hpp"

#include "services/projector/dlp/protocol/payload.hpp"

namespace handcast::dlp {
namespace {

using protocol::append;
using protocol::Bytes;
using protocol::Command;

constexpr std::uint8_t kFromVideo = 0;
constexpr std::uint8_t kOneBit = 1;
constexpr std::uint8_t kClosed = 0, kPatternMailbox = 2;
/// An edge of a trigger output of the DLPC350 at that of its pattern; a step is 107.2 ns.
constexpr std::uint8_t kNoDelay = 0xbb;
constexpr std::uint8_t kActiveHigh = 0;

/// What the DLPC350 waits for before a pattern. In trigger mode kVerticalSync, the vertical sync is
/// the edge that the first pattern waits for.
enum class WaitsFor : std::uint8_t { rising_edge = 1, nothing = 3 };

WaitsFor waits_for(const Sequence& sequence, std::size_t i, bool trigger_in) {
  const bool waits = i == 0 || (trigger_in && sequence.patterns[i].begins_sub_frame);
  return waits ? WaitsFor::rising_edge : WaitsFor::nothing;
}

/// The look-up table of the DLPC350, 3 bytes per pattern (DLPU010, "Pattern Definition").
Bytes table_of(const Sequence& sequence, bool trigger_in) {
  Bytes table;
  for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
    const Pattern& pattern = sequence.patterns[i];
    const auto wait = static_cast<unsigned>(waits_for(sequence, i, trigger_in));
    table.push_back(static_cast<std::uint8_t>(wait | static_cast<unsigned>(pattern.bit) << 2));
    table.push_back(static_cast<std::uint8_t>(kOneBit | pattern.leds << 4));
    table.push_back(0);  // not inverted, no black after it, no change of the buffer
  }
  return table;
}

}  // namespace

std::vector<Setting> encode_for_dlpc350(const Sequence& sequence, const Triggers& triggers) {
  const auto last = static_cast<std::uint8_t>(sequence.patterns.size() - 1);
  constexpr std::uint8_t kRepeat = 1, kOneImage = 0;
  Bytes period;
  append<4>(period, sequence.exposure_us);
  append<4>(period, sequence.exposure_us);
  std::vector<Setting> settings{
      {Command::pattern_source, {kFromVideo}},
      {Command::pattern_count, {last, kRepeat, last, kOneImage}},
      {Command::trigger_mode, {triggers.in ? protocol::kExternalTrigger : protocol::kVerticalSync}},
      {Command::pattern_period, period},
  };
  if (triggers.out) {
    settings.push_back({Command::trigger_out_1, {kActiveHigh, kNoDelay, kNoDelay}});
    settings.push_back({Command::trigger_out_2, {kActiveHigh, kNoDelay}});
  }
  settings.push_back({Command::mailbox, {kPatternMailbox}});
  settings.push_back({Command::mailbox_address, {0}});
  settings.push_back({Command::pattern_definition, table_of(sequence, triggers.in)});
  settings.push_back({Command::mailbox, {kClosed}});
  return settings;
}

std::vector<Setting> encode_for_dlpc900(const Sequence& sequence, const Triggers& triggers) {
  constexpr std::uint32_t kForever = 0;
  std::vector<Setting> settings;
  if (triggers.out)
    for (const auto output : {Command::trigger_out_1, Command::trigger_out_2})
      settings.push_back({output, {kActiveHigh, 0, 0, 0, 0}});  // edges in µs, 2 bytes each
  for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
    const Pattern& pattern = sequence.patterns[i];
    const bool pulse = triggers.out && i == 0;
    Bytes definition;
    append<2>(definition, static_cast<std::uint32_t>(i));
    append<3>(definition, sequence.exposure_us);
    constexpr unsigned kWaitsForSync = 0x80;
    definition.push_back(static_cast<std::uint8_t>((kOneBit - 1) << 1 | pattern.leds << 4 |
                                                   (i == 0 ? kWaitsForSync : 0)));
    append<3>(definition, 0);  // no dark time
    definition.push_back(pulse ? 0 : 1);
    append<2>(definition, static_cast<std::uint32_t>(pattern.bit) << 11);
    settings.push_back({Command::pattern_definition, std::move(definition)});
  }
  Bytes count;
  append<2>(count, static_cast<std::uint32_t>(sequence.patterns.size()));
  append<4>(count, kForever);
  settings.push_back({Command::pattern_count, std::move(count)});
  return settings;
}

}  // namespace handcast::dlp
