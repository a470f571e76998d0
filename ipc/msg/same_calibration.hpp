// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/base/result.hpp"

namespace handcast::msg {

/// Whether a message may be read with the calibration `ours`: the ids are equal, or one of them is
/// 0. While a rig takes a new calibration (`handcast reload`), its services change one after the
/// other. Errors: bad_data (the message belongs to another calibration; it must not be used).
template <class Message>
Result<void> check_calibration(const Message& message, std::uint32_t ours) {
  if (message.calibration == 0 || ours == 0 || message.calibration == ours) return {};
  return fail(Errc::bad_data,
              "what arrives belongs to another calibration, and is left out until all services "
              "have the same one");
}

}  // namespace handcast::msg
