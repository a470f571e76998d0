// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "services/projector/dlp/hid_device.hpp"
#include "services/projector/dlp/protocol/message.hpp"
#include "services/projector/dlp/sequence/encode.hpp"

namespace handcast::dlp {

/// The time in which a controller answers a command. It usually takes a few milliseconds.
inline constexpr std::int64_t kAnswer_ns = 250'000'000;

/// Sends commands to a controller and waits for its replies. A command without a whole reply is
/// sent a second time: all commands set or read something, so that it does no harm if the first one
/// arrived. One thread.
class Link {
 public:
  Link(std::unique_ptr<HidDevice> device, protocol::Controller controller)
      : device_(std::move(device)), controller_(controller) {}

  /// Reads at least `least` bytes. Errors: bad_data (damaged, too short or refused twice),
  /// disconnected (no reply).
  Result<protocol::Bytes> read(protocol::Command command, std::size_t least, Deadline deadline);
  /// Sets something. Errors: unavailable (refused), bad_data (damaged replies), disconnected.
  Result<void> write(protocol::Command command, std::span<const std::uint8_t> data,
                     Deadline deadline);

  protocol::Controller controller() const { return controller_; }

 private:
  Result<protocol::Reply> exchange(protocol::Command command, protocol::Direction direction,
                                   std::span<const std::uint8_t> data, Deadline deadline);
  Result<protocol::Reply> try_once(protocol::Command command, protocol::Direction direction,
                                   std::span<const std::uint8_t> data, Deadline deadline);
  void drop_old_reports();
  std::string why_refused(Deadline deadline);

  std::unique_ptr<HidDevice> device_;
  protocol::Controller controller_;
  std::uint8_t sequence_ = 0;
};

/// Sends commands until one fails.
Result<void> send_all(Link& link, const std::vector<Setting>& settings, Deadline deadline);

}  // namespace handcast::dlp
