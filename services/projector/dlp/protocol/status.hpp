// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "services/projector/dlp/protocol/command.hpp"

namespace handcast::dlp::protocol {

/// The three status bytes of a controller, as it sends them.
struct Status {
  std::uint8_t hardware = 0x01, system = 0x01, main = 0x00;
};

/// The sequence of patterns, or the video, runs.
bool is_running(const Status& status);

/// What is wrong, one sentence each; empty if nothing is. Mirrors that are parked count, a sequence
/// that stands still does not.
std::vector<std::string_view> faults_of(Controller controller, const Status& status);

/// What the DLPC350 says about a sequence.
struct Validation {
  std::vector<std::string_view> errors;    ///< the sequence cannot be shown
  std::vector<std::string_view> warnings;  ///< it is shown, but perhaps not as meant
};
/// `bits`: the reply to validate. Bit 7, still at work, is ignored.
Validation explain_validation(std::uint8_t bits);
/// The controller is still at work.
constexpr bool is_validating(std::uint8_t bits) { return (bits & 0x80) != 0; }

}  // namespace handcast::dlp::protocol
