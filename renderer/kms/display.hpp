// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drmMode.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::renderer::kms {

/// A video mode of a display.
struct Mode {
  /// Resolution in pixels.
  /// @{
  int width_px = 0, height_px = 0;
  /// @}
  double rate_hz = 0;
  drmModeModeInfo timing{};  ///< as the kernel lists it
};

/// The mode with a timing of the kernel.
Mode mode_of(const drmModeModeInfo& timing);
/// E.g. "1280x800@59.81".
std::string describe(const Mode& mode);

/// The index of the mode that is meant by `wanted`: WIDTHxHEIGHT or WIDTHxHEIGHT@HZ. A part that it
/// leaves out is taken from `projector`, whose rate need only be near. Errors, with a list of the
/// modes: bad_config (`wanted` is not a mode), unavailable (there is no such mode).
Result<std::size_t> choose_mode(std::span<const Mode> modes, std::string_view wanted,
                                const Mode& projector);

/// A connector of a graphics card, and the monitor or projector on it.
struct Display {
  std::string card;  ///< e.g. "/dev/dri/card0"
  std::uint32_t connector_id = 0;
  std::string connector;  ///< e.g. "HDMI-A-1"
  std::string model;      ///< the name in its EDID, e.g. "EPSON PJ"; empty if it has none
  bool is_connected = false;
  std::vector<Mode> modes;  ///< not interlaced; the preferred one first
};

/// E.g. "'HDMI-A-1' (EPSON PJ, 1280x800@60)".
std::string describe(const Display& display);

/// The index of the display that is meant by `wanted`: a connector or a model. Empty: the only one
/// that is connected. Errors, with a list of the connectors: bad_config (several fit), unavailable
/// (none fits; it may be switched off).
Result<std::size_t> choose_display(std::span<const Display> displays, std::string_view wanted);

}  // namespace handcast::renderer::kms
