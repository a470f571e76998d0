// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/protocol/command.hpp"

namespace handcast::dlp::protocol {

std::string_view name_of(Command command) {
  switch (command) {
    case Command::error_code:
      return "error code (0x0100)";
    case Command::power:
      return "power (0x0200)";
    case Command::version:
      return "version (0x0205)";
    case Command::video_signal:
      return "video signal (0x071C)";
    case Command::led_currents:
      return "LED currents (0x0B01)";
    case Command::source:
      return "input source (0x1A00)";
    case Command::pixel_format:
      return "pixel format (0x1A02)";
    case Command::led_enables:
      return "LED enables (0x1A07)";
    case Command::hardware_status:
      return "hardware status (0x1A0A)";
    case Command::system_status:
      return "system status (0x1A0B)";
    case Command::main_status:
      return "main status (0x1A0C)";
    case Command::validate:
      return "validation (0x1A1A)";
    case Command::display_mode:
      return "display mode (0x1A1B)";
    case Command::trigger_out_1:
      return "trigger output 1 (0x1A1D)";
    case Command::trigger_out_2:
      return "trigger output 2 (0x1A1E)";
    case Command::pattern_source:
      return "pattern source (0x1A22)";
    case Command::trigger_mode:
      return "trigger mode (0x1A23)";
    case Command::pattern_display:
      return "start and stop (0x1A24)";
    case Command::pattern_period:
      return "exposure and period (0x1A29)";
    case Command::pattern_count:
      return "number of patterns (0x1A31)";
    case Command::mailbox_address:
      return "mailbox address (0x1A32)";
    case Command::mailbox:
      return "mailbox (0x1A33)";
    case Command::pattern_definition:
      return "pattern definition (0x1A34)";
  }
  return "unknown command";
}

}  // namespace handcast::dlp::protocol
