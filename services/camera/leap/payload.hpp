// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "ipc/base/result.hpp"

namespace handcast::camera::leap {

/// One payload of a video stream: a header and bytes of an image (USB Device Class Definition for
/// Video Devices 1.0, section 2.4.3.3).
struct Payload {
  bool frame_id = false;               ///< changes from each image to the next
  bool ends_frame = false;             ///< the last payload of its image
  bool has_error = false;              ///< the camera says that its image is damaged
  std::optional<std::uint32_t> stamp;  ///< time of its image, ticks of the camera's clock
  std::span<const std::uint8_t> data;  ///< a part of `bytes`; may be empty
};

/// Takes a payload apart. Errors: bad_data (the header is not one).
Result<Payload> parse_payload(std::span<const std::uint8_t> bytes);

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
