// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk::midi {

/// A MIDI device, in and out. One thread.
class Port {
 public:
  virtual ~Port() = default;

  virtual const std::string& name() const = 0;
  /// The messages since the last call; at most 1024, further ones are lost.
  virtual std::vector<std::vector<std::uint8_t>> receive() = 0;
  /// Sends a message, if the device takes any.
  virtual void send(std::span<const std::uint8_t> message) = 0;
  /// False if the device was pulled. It asks the system: some times a second at most.
  virtual bool is_there() = 0;
};

/// Opens the first device whose name has this part; "jack:PART": one of JACK, otherwise of ALSA.
/// Errors: disconnected (there is no such device; the sentence lists them), unavailable (this
/// computer has no MIDI).
Result<std::unique_ptr<Port>> open_port(std::string_view device);

}  // namespace handcast::desk::midi
