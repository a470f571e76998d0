// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::renderer {

/// A monitor or projector that is connected.
struct Monitor {
  std::string output;  ///< the connector, e.g. "HDMI-1"
  std::string model;   ///< the name in its EDID, e.g. "EPSON PJ"; empty if it has none
  /// Resolution in pixels.
  /// @{
  int width_px = 0, height_px = 0;
  /// @}
  double rate_hz = 0;
  bool is_primary = false;  ///< the operator's own
};

/// E.g. "1: 'HDMI-1' (EPSON PJ, 1280x800, 60 Hz)".
std::string describe(const Monitor& monitor, std::size_t index);

/// The index of the monitor that is meant by `wanted`: an output, a model, or an index. Empty: the
/// only one that is not primary. The primary one is only chosen by its name or index. Errors, with
/// a list of the monitors: bad_config (several fit), unavailable (none fits; it may be switched
/// off).
Result<std::size_t> choose_monitor(std::span<const Monitor> monitors, std::string_view wanted);

}  // namespace handcast::renderer
