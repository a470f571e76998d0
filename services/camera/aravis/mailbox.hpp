// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/msg/frame_losses.hpp"
#include "services/camera/aravis/glib.hpp"

namespace handcast::camera::aravis {

/// An image of a stream. Its buffer goes back to the stream when it is destroyed.
class Image {
 public:
  Image(Owned<ArvStream> stream, Owned<ArvBuffer> buffer)
      : stream_(std::move(stream)), buffer_(std::move(buffer)) {}
  Image(Image&&) noexcept = default;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  ArvBuffer* buffer() const { return buffer_.get(); }

  std::uint64_t number = 0;           ///< grows with each exposure, also with one that was lost
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  std::int64_t exposure_ns = 0;       ///< duration of the exposure
  std::int64_t arrived_ns = 0;        ///< CLOCK_MONOTONIC
  msg::FrameLosses lost;              ///< since the image that was taken before

 private:
  Owned<ArvStream> stream_;
  Owned<ArvBuffer> buffer_;
};

/// Holds the newest image until it is taken. It outlives the streams that fill it. Any thread.
class Mailbox {
 public:
  /// Replaces the image that is waiting, if there is one, which counts as skipped. `steps`: number
  /// of exposures since the last image, this one included.
  void put(Image image, std::uint64_t steps);
  /// Counts exposures that did not become an image.
  void count(const msg::FrameLosses& lost, std::uint64_t steps);
  /// The newest image, as soon as there is one; empty at the deadline.
  std::optional<Image> take(Deadline deadline);
  /// Drops the image that is waiting, which counts as skipped. An image keeps its camera open.
  void clear();
  /// When the last image arrived, or one that was incomplete; 0 if none has. CLOCK_MONOTONIC.
  std::int64_t last_arrival_ns() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::optional<Image> newest_;
  msg::FrameLosses lost_;
  std::uint64_t number_ = 0;
  std::int64_t last_arrival_ns_ = 0;
};

}  // namespace handcast::camera::aravis
