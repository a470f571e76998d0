// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

namespace handcast::renderer::kms {

/// Notices within a quarter of a second that a display is unplugged or plugged in again. It asks on
/// a thread of its own, because the kernel lets the question wait while another program asks a
/// display for its modes.
class PlugWatch {
 public:
  /// `card` must stay open while this object lives.
  PlugWatch(int card, std::uint32_t connector_id);

  /// Any thread.
  bool is_plugged() const { return is_plugged_; }

 private:
  std::atomic<bool> is_plugged_ = true;
  std::jthread thread_;
};

}  // namespace handcast::renderer::kms
