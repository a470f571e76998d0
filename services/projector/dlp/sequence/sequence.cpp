// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/sequence/sequence.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "config/sections/sub_frames.hpp"
#include "config/settings/choice.hpp"

namespace handcast::dlp {
namespace {

using protocol::Controller;

constexpr int kPatterns = 24;
constexpr int kRedBits = 8, kBlueBits = 16;  ///< first bits of these colours
/// Of an output frame.
constexpr double kUsed = 0.995;

std::vector<Pattern> grey_planes(std::uint8_t leds) {
  std::vector<Pattern> patterns;
  patterns.reserve(kPatterns);
  for (int bit = 0; bit < kPatterns; ++bit) patterns.push_back({.bit = bit, .leds = leds});
  return patterns;
}

/// The colours of a sub-frame follow each other; each is lit by its own LED.
std::vector<Pattern> colour_planes(std::uint8_t leds) {
  std::vector<Pattern> patterns;
  const auto lit = [&](std::uint8_t led) { return static_cast<std::uint8_t>(leds & led); };
  for (int bit = 0; bit < config::sub_frames_of(config::Packing::planes_8x3); ++bit) {
    patterns.push_back({.bit = bit, .leds = lit(protocol::kGreen)});
    patterns.push_back(
        {.bit = kRedBits + bit, .leds = lit(protocol::kRed), .begins_sub_frame = false});
    patterns.push_back(
        {.bit = kBlueBits + bit, .leds = lit(protocol::kBlue), .begins_sub_frame = false});
  }
  return patterns;
}

}  // namespace

std::optional<int> least_exposure_us(Controller controller, int bits) {
  constexpr std::array kDlpc350_us{235, 700, 1570, 1700, 2000, 2500, 4500, 8333};
  constexpr int kDlpc900OneBit_us = 105;
  if (bits < 1 || bits > static_cast<int>(kDlpc350_us.size())) return std::nullopt;
  if (controller == Controller::dlpc350) return kDlpc350_us[static_cast<std::size_t>(bits - 1)];
  return bits == 1 ? std::optional(kDlpc900OneBit_us) : std::nullopt;
}

Result<Sequence> make_sequence(Controller controller, const config::Projector& projector,
                               std::uint8_t leds) {
  Sequence sequence;
  if (projector.packing == config::Packing::planes_24x1) sequence.patterns = grey_planes(leds);
  if (projector.packing == config::Packing::planes_8x3) sequence.patterns = colour_planes(leds);
  if (sequence.patterns.empty())
    return fail(
        Errc::bad_config,
        fmt::format("dlp.mode = \"pattern\" shows bit planes, which projector.packing = \"{}\" "
                    "does not make; set it to \"24x1\" or \"8x3\", or dlp.mode to \"video\"",
                    config::word_of(projector.packing)));
  const double frame_us = 1e6 / config::output_of(projector).rate_hz;
  sequence.exposure_us = static_cast<std::uint32_t>(kUsed * frame_us / kPatterns);
  const int least_us = least_exposure_us(controller, 1).value_or(0);
  if (sequence.exposure_us < static_cast<std::uint32_t>(least_us))
    return fail(
        Errc::bad_config,
        fmt::format("projector.rate_hz = {:g}: a pattern would last {} µs, and the {} needs "
                    "{} µs; with this packing, at most {:.0f} are possible",
                    projector.rate_hz, sequence.exposure_us, protocol::name_of(controller),
                    least_us,
                    std::floor(kUsed * 1e6 / (kPatterns * least_us) *
                               config::sub_frames_of(projector.packing))));
  return sequence;
}

}  // namespace handcast::dlp
