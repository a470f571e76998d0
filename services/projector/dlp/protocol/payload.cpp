// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/protocol/payload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace handcast::dlp::protocol {
namespace {

constexpr double kFullScale = 255;

/// Rounded down, so that a current never exceeds its limit.
std::uint8_t level_of(bool is_inverted, double current, double limit) {
  const double share = std::clamp(std::min(current, limit), 0.0, 1.0);
  const auto level = static_cast<int>(share * kFullScale);
  return static_cast<std::uint8_t>(is_inverted ? 255 - level : level);
}

}  // namespace

bool is_inverted(config::LedSignal signal, Controller controller) {
  if (signal == config::LedSignal::automatic) return controller == Controller::dlpc350;
  return signal == config::LedSignal::inverted;
}

Bytes encode_currents(bool is_inverted, const Currents& currents, double limit) {
  return {level_of(is_inverted, currents.red, limit), level_of(is_inverted, currents.green, limit),
          level_of(is_inverted, currents.blue, limit)};
}

std::uint8_t enables_of(const Currents& currents) {
  const auto leds =
      static_cast<std::uint8_t>((currents.red > 0 ? kRed : 0) | (currents.green > 0 ? kGreen : 0) |
                                (currents.blue > 0 ? kBlue : 0));
  return leds == 0 ? leds : static_cast<std::uint8_t>(leds | kSequencer);
}

Result<std::string> decode_version(std::span<const std::uint8_t> data) {
  if (data.size() < 4)
    return fail(Errc::bad_data, fmt::format("a version has only {} bytes", data.size()));
  return fmt::format("{}.{}.{}", data[3], data[2], data[0] | data[1] << 8);
}

std::string explain_error_code(std::uint8_t code) {
  constexpr std::array<std::string_view, 18> kReasons{
      "it reports no error",
      "a batch file is damaged",
      "the device has failed",
      "it does not know the command",
      "controller and mirrors do not fit together",
      "the command is not allowed in the present mode",
      "a value of the command is not allowed",
      "something that the command refers to is not there",
      "its memory is full",
      "the compression of a picture is not allowed",
      "the number of a bit is out of range",
      "a picture is not in its flash memory",
      "the dark time of a pattern is out of range",
      "the delay of a signal is out of range",
      "the exposure of a pattern is out of range",
      "the number of a pattern is out of range",
      "the definition of a pattern is not valid",
      "the address of a picture is out of range",
  };
  if (code < kReasons.size()) return std::string(kReasons[code]);
  return code == 255 ? "it has an internal error" : fmt::format("its error code is {}", code);
}

}  // namespace handcast::dlp::protocol
