// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "config/sections/leap.hpp"
#include "ipc/base/result.hpp"
#include "services/camera/leap/descriptors.hpp"

namespace handcast::camera::leap {

/// A control transfer (USB 2.0, section 9.3).
struct ControlTransfer {
  std::uint8_t request_type = 0;     ///< bmRequestType: direction, kind, recipient
  std::uint8_t request = 0;          ///< bRequest
  std::uint16_t value = 0;           ///< wValue
  std::uint16_t index = 0;           ///< wIndex
  std::uint16_t length = 0;          ///< bytes that are read; of one that writes, those in `data`
  std::vector<std::uint8_t> data{};  ///< what is written

  /// The device answers with data.
  bool reads() const { return (request_type & 0x80) != 0; }
};

/// A control of the controller. Each has 16 bits.
struct Control {
  std::uint8_t unit = 0;      ///< number of its unit or terminal
  std::uint8_t selector = 0;  ///< its number there
};
/// What the controls of a video camera do in this one. Exposure: in microseconds. The switch: see
/// SwitchBit. Memory: a byte is read at the address that was set.
/// @{
inline constexpr Control kExposure{2, 0x0b};
inline constexpr Control kDigitalGain{5, 0x02};
inline constexpr Control kSwitch{5, 0x03};
inline constexpr Control kGain{5, 0x04};
inline constexpr Control kMemoryByte{5, 0x07};
inline constexpr Control kMemoryAddress{5, 0x08};
inline constexpr Control kGamma{5, 0x09};
/// @}
/// What kSwitch switches: the number in its lowest bits.
enum SwitchBit : std::uint16_t { kLeftLed = 2, kCentreLed = 3, kRightLed = 4 };
/// Added to a SwitchBit: on; without it, off.
inline constexpr std::uint16_t kSwitchOn = 1 << 6;

/// Sets or reads a control.
/// @{
ControlTransfer set_control(Control control, std::uint16_t value);
ControlTransfer get_control(Control control);
/// @}

/// The settings of a rig as control transfers. `exposure_ms`: rounded to 1 us. Errors: bad_config
/// (the exposure is longer than the period of the mode, or than the controller can count).
Result<std::vector<ControlTransfer>> transfers_of(const config::Leap& settings, double exposure_ms,
                                                  const StreamMode& mode);

/// Asks for a mode, reads what the camera makes of it, and starts it with that (section 4.3.1.1).
/// @{
ControlTransfer probe(const StreamMode& mode);
ControlTransfer read_probe();
ControlTransfer commit(std::span<const std::uint8_t> probed);
/// @}
/// The bytes of the largest payload in an answer to read_probe(). Errors: bad_data (the answer is
/// too short, of another mode, or has no such size).
Result<std::size_t> payload_bytes_of(std::span<const std::uint8_t> probed, const StreamMode& mode);

}  // namespace handcast::camera::leap
