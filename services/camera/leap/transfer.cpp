// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/transfer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "services/camera/leap/little_endian.hpp"

namespace handcast::camera::leap {
namespace {

/// To and from an interface, of its class.
constexpr std::uint8_t kToInterface = 0x21, kFromInterface = 0xa1;
constexpr std::uint8_t kSetCurrent = 0x01, kGetCurrent = 0x81;
constexpr std::uint16_t kProbe = 0x0100, kCommit = 0x0200, kStreamingInterface = 1;
constexpr std::uint16_t kControlBytes = 2;
/// The block of the probe in version 1.0.
constexpr std::uint16_t kProbeBytes = 26;
constexpr std::size_t kProbeFormat = 2, kProbeFrame = 3, kProbeTicks = 4, kProbePayload = 22;
constexpr std::size_t kLeastPayload = 64, kLargestPayload = 1 << 20;
constexpr double kLongestExposure_ms = 65.535;

ControlTransfer switch_on(SwitchBit bit, bool on) {
  return set_control(kSwitch, static_cast<std::uint16_t>(bit | (on ? kSwitchOn : 0)));
}

}  // namespace

ControlTransfer set_control(Control control, std::uint16_t value) {
  ControlTransfer transfer{kToInterface, kSetCurrent,
                           static_cast<std::uint16_t>(control.selector << 8),
                           static_cast<std::uint16_t>(control.unit << 8), kControlBytes};
  transfer.data.resize(kControlBytes);
  put_16(transfer.data, 0, value);
  return transfer;
}

ControlTransfer get_control(Control control) {
  return {kFromInterface, kGetCurrent, static_cast<std::uint16_t>(control.selector << 8),
          static_cast<std::uint16_t>(control.unit << 8), kControlBytes};
}

Result<std::vector<ControlTransfer>> transfers_of(const config::Leap& settings, double exposure_ms,
                                                  const StreamMode& mode) {
  const double period_ms = 1e3 / mode.rate_hz;
  if (exposure_ms > period_ms || exposure_ms > kLongestExposure_ms)
    return fail(Errc::bad_config,
                fmt::format("exposure_ms: {:g} ms is longer than {:.4g} ms, the period of "
                            "{}x{} at {:.4g} Hz",
                            exposure_ms, period_ms, mode.width_px, mode.height_px, mode.rate_hz));
  const auto exposure_us = static_cast<std::uint16_t>(std::lround(exposure_ms * 1e3));
  return std::vector<ControlTransfer>{
      set_control(kExposure, exposure_us),
      set_control(kGain, static_cast<std::uint16_t>(settings.gain)),
      set_control(kDigitalGain, static_cast<std::uint16_t>(settings.digital_gain)),
      set_control(kGamma, settings.gamma ? 1 : 0),
      switch_on(kLeftLed, settings.led_left),
      switch_on(kCentreLed, settings.led_centre),
      switch_on(kRightLed, settings.led_right),
  };
}

ControlTransfer probe(const StreamMode& mode) {
  ControlTransfer transfer{kToInterface, kSetCurrent, kProbe, kStreamingInterface, kProbeBytes};
  transfer.data.resize(kProbeBytes);
  put_16(transfer.data, 0, 1);  // the interval is kept
  transfer.data[kProbeFormat] = mode.format;
  transfer.data[kProbeFrame] = mode.frame;
  put_32(transfer.data, kProbeTicks, mode.ticks);
  return transfer;
}

ControlTransfer read_probe() {
  return {kFromInterface, kGetCurrent, kProbe, kStreamingInterface, kProbeBytes};
}

ControlTransfer commit(std::span<const std::uint8_t> probed) {
  return {kToInterface,
          kSetCurrent,
          kCommit,
          kStreamingInterface,
          static_cast<std::uint16_t>(probed.size()),
          {probed.begin(), probed.end()}};
}

Result<std::size_t> payload_bytes_of(std::span<const std::uint8_t> probed, const StreamMode& mode) {
  if (probed.size() < kProbeBytes)
    return fail(Errc::bad_data,
                fmt::format("the controller describes its stream in {} bytes instead of {}",
                            probed.size(), kProbeBytes));
  if (probed[kProbeFormat] != mode.format || probed[kProbeFrame] != mode.frame)
    return fail(Errc::bad_data, fmt::format("the controller does not accept {}x{} px",
                                            mode.width_px, mode.height_px));
  const std::size_t bytes = get_32(probed, kProbePayload);
  if (bytes < kLeastPayload || bytes > kLargestPayload)
    return fail(Errc::bad_data,
                fmt::format("the controller wants to send payloads of {} bytes", bytes));
  return bytes;
}

}  // namespace handcast::camera::leap
