// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace handcast::dlp::protocol {

/// The controllers that are known.
enum class Controller {
  dlpc350,  ///< of the DLP LightCrafter 4500
  dlpc900,  ///< of the DLP LightCrafter 6500 and 9000
};

constexpr std::string_view name_of(Controller controller) {
  return controller == Controller::dlpc350 ? "DLPC350" : "DLPC900";
}

/// The commands that handcast uses, by their USB numbers. Source: TI DLPU010 (DLPC350), DLPU018
/// (DLPC900).
enum class Command : std::uint16_t {
  error_code = 0x0100,    ///< DLPC900: why the last command was refused
  power = 0x0200,         ///< 0 normal, 1 standby
  version = 0x0205,       ///< four versions of 4 bytes
  video_signal = 0x071c,  ///< DLPC350: whether the video signal is locked, its timing
  led_currents = 0x0b01,  ///< duty of red, green and blue, a byte each
  source = 0x1a00,        ///< DLPC350: input and its width
  pixel_format = 0x1a02,  ///< DLPC350: 0 is RGB 4:4:4
  led_enables = 0x1a07,   ///< kRed … kSequencer
  hardware_status = 0x1a0a,
  system_status = 0x1a0b,
  main_status = 0x1a0c,
  validate = 0x1a1a,      ///< DLPC350: checks the pattern sequence
  display_mode = 0x1a1b,  ///< kVideoMode, or the pattern mode of the controller
  trigger_out_1 = 0x1a1d,
  trigger_out_2 = 0x1a1e,
  pattern_source = 0x1a22,   ///< DLPC350: 0 is the video input
  trigger_mode = 0x1a23,     ///< DLPC350: kVerticalSync or kExternalTrigger
  pattern_display = 0x1a24,  ///< kStop or kStart
  pattern_period = 0x1a29,   ///< DLPC350: exposure and period in µs, 4 bytes each
  pattern_count = 0x1a31,    ///< number of patterns of the sequence
  mailbox_address = 0x1a32,  ///< DLPC350
  mailbox = 0x1a33,          ///< DLPC350: 0 closed, 2 pattern definitions
  pattern_definition = 0x1a34,
};

/// The command in words: "LED currents (0x0B01)".
std::string_view name_of(Command command);

/// Values of led_enables.
/// @{
inline constexpr std::uint8_t kRed = 1, kGreen = 2, kBlue = 4;
inline constexpr std::uint8_t kSequencer = 8;  ///< the sequence switches the LEDs
/// @}

inline constexpr std::uint8_t kStop = 0, kStart = 2;
inline constexpr std::uint8_t kVideoMode = 0;
inline constexpr std::uint8_t kVerticalSync = 0, kExternalTrigger = 1;

}  // namespace handcast::dlp::protocol
