// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/camera/v4l2/device.hpp"
#include "services/camera/v4l2/origin.hpp"

namespace handcast::camera::v4l2 {

/// An image that the driver has written. Its memory is valid until Stream::give_back().
struct Filled {
  std::uint32_t buffer = 0;    ///< the number of its buffer
  std::uint32_t sequence = 0;  ///< the driver's number of the image
  bool is_broken = false;      ///< the driver says that data are missing
  std::span<const std::uint8_t> bytes;
  ImageTimes times;
};

/// The buffers that a driver fills, mapped into this process, and the stream that fills them. One
/// thread.
class Stream {
 public:
  /// Shares buffers with the driver and starts the stream. `device` must outlive it. Errors:
  /// unavailable (in use, or too little memory or USB bandwidth), disconnected, bad_config.
  static Result<std::unique_ptr<Stream>> start(const Device& device);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Waits until an image is there. Errors: timeout, disconnected.
  Result<void> wait(Deadline deadline) const;
  /// The oldest image that is there; empty if there is none. Errors: disconnected.
  Result<std::optional<Filled>> take();
  /// Lets the driver fill the buffer of an image again. Errors: disconnected.
  Result<void> give_back(const Filled& image);

  /// The number of buffers.
  std::size_t buffers() const { return buffers_.size(); }

 private:
  using Buffer = std::span<std::uint8_t>;
  explicit Stream(const Device& device) : device_(device) {}
  Result<void> share_buffers();
  Result<void> map(std::uint32_t number);
  Result<void> queue(std::uint32_t number);
  tl::unexpected<Error> lost(std::string_view what, int number) const;

  const Device& device_;
  std::vector<Buffer> buffers_;
};

}  // namespace handcast::camera::v4l2
