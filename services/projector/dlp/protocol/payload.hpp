// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "config/sections/dlp.hpp"
#include "services/projector/dlp/protocol/message.hpp"

namespace handcast::dlp::protocol {

/// Appends a number, lowest byte first.
template <int kBytes>
void append(Bytes& bytes, std::uint32_t number) {
  for (int i = 0; i < kBytes; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

/// Shares of the full scale of the LED drivers, 0 to 1.
struct Currents {
  double red = 0, green = 0, blue = 0;
};

/// True if 255 means no current. The LightCrafter 4500 inverts the signal although its manual says
/// otherwise, and TI's own program sends 255 minus the value; the boards with a DLPC900 do not.
bool is_inverted(config::LedSignal signal, Controller controller);

/// The data of led_currents; no current exceeds `limit`.
Bytes encode_currents(bool is_inverted, const Currents& currents, double limit);

/// The enables of the LEDs that have a current, for the sequence to switch; 0 if none has one.
std::uint8_t enables_of(const Currents& currents);

/// The first of the four versions: "3.1.0". Errors: bad_data (fewer than 4 bytes).
Result<std::string> decode_version(std::span<const std::uint8_t> data);

/// Why the DLPC900 refused a command, by its error code.
std::string explain_error_code(std::uint8_t code);

}  // namespace handcast::dlp::protocol
