// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/msg/frame_losses.hpp"
#include "services/camera/aravis/glib.hpp"
#include "services/camera/keep/mailbox.hpp"

namespace handcast::camera::aravis {

/// An image of a stream, or none. Its buffer goes back to the stream when it is destroyed.
class Image {
 public:
  Image() = default;
  Image(Owned<ArvStream> stream, Owned<ArvBuffer> buffer)
      : stream_(std::move(stream)), buffer_(std::move(buffer)) {}
  Image(Image&&) noexcept = default;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  ArvBuffer* buffer() const { return buffer_.get(); }

  std::uint64_t number = 0;           ///< see Mailbox
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  std::int64_t exposure_ns = 0;       ///< duration of the exposure
  msg::FrameLosses lost;              ///< see Mailbox

 private:
  Owned<ArvStream> stream_;
  Owned<ArvBuffer> buffer_;
};

/// An image that waits in it keeps its camera open.
using Mailbox = camera::Mailbox<Image>;

}  // namespace handcast::camera::aravis
