// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/kms/mode.hpp"

namespace handcast::renderer::kms {

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
