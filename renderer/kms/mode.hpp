// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drmMode.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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

}  // namespace handcast::renderer::kms
