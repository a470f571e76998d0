// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

namespace handcast::camera::leap {

/// Takes what a stream delivers, on the stream's thread.
class PayloadSink {
 public:
  virtual ~PayloadSink() = default;
  /// A payload has arrived. CLOCK_MONOTONIC.
  virtual void on_payload(std::span<const std::uint8_t> bytes, std::int64_t arrived_ns) = 0;
  /// A transfer failed: one or more payloads are lost.
  virtual void on_lost_payload() = 0;
};

}  // namespace handcast::camera::leap
