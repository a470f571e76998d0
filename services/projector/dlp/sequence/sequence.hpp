// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "config/sections/projector.hpp"
#include "ipc/base/result.hpp"
#include "services/projector/dlp/protocol/command.hpp"

namespace handcast::dlp {

/// One bit of the output frame, shown for the exposure of the sequence.
struct Pattern {
  int bit = 0;                   ///< 0 to 7 of green, 8 to 15 of red, 16 to 23 of blue
  std::uint8_t leds = 0;         ///< protocol::kRed, kGreen, kBlue
  bool begins_sub_frame = true;  ///< 8x3: only the first of three does
};

/// What a controller shows of each output frame, one pattern after the other.
struct Sequence {
  std::vector<Pattern> patterns;
  std::uint32_t exposure_us = 0;  ///< of each pattern; the next one follows at once
};

/// The least time that a pattern of `bits` (1 to 8) takes; empty if it is not known. Source of the
/// DLPC350: TI DLPU010, "Pattern Display Exposure and Frame Period".
std::optional<int> least_exposure_us(protocol::Controller controller, int bits);

/// The sequence for the packing of a projector, in the order of renderer::Packer. `leds`: those
/// that have a current. A sequence ends 0.5 % before the output frame, because an output is rarely
/// as slow as its nominal rate. Errors: bad_config (a packing without bit planes; patterns shorter
/// than the controller permits).
Result<Sequence> make_sequence(protocol::Controller controller, const config::Projector& projector,
                               std::uint8_t leds);

}  // namespace handcast::dlp
