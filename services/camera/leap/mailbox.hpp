// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/msg/frame_losses.hpp"

namespace handcast::camera::leap {

/// The images of both eyes: byte 2i is pixel i of the left one, byte 2i + 1 of the right one.
struct StereoImage {
  std::vector<std::uint8_t> bytes;    ///< two for each pixel
  std::uint64_t number = 0;           ///< grows with each exposure, also with one that was lost
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  msg::FrameLosses lost;              ///< since the image that was taken before
};

/// Holds the newest image until it is taken. It outlives the streams that fill it. Any thread.
class Mailbox {
 public:
  /// `first`: the number of the first image.
  explicit Mailbox(std::uint64_t first) : number_(first) {}

  /// Puts an image there. One that is waiting is replaced, which counts as skipped. `image` gets
  /// another buffer for its bytes. `steps`: exposures since the last image, this one included.
  void put(StereoImage& image, std::uint64_t steps);
  /// Counts exposures that did not become an image; `steps` as for put().
  void count(const msg::FrameLosses& lost, std::uint64_t steps);
  /// Takes the newest image as soon as there is one; `image` gives its buffer. False at the
  /// deadline.
  bool take(StereoImage& image, Deadline deadline);
  /// When the last image came, whole or torn; 0 if none has. CLOCK_MONOTONIC.
  std::int64_t last_sign_ns() const;
  /// The middle of the exposure of the last image; 0 if there is none.
  std::int64_t last_exposed_ns() const;

 private:
  void advance(const msg::FrameLosses& lost, std::uint64_t steps);

  mutable std::mutex mutex_;
  std::condition_variable came_;
  StereoImage newest_;
  bool is_full_ = false, has_begun_ = false;
  msg::FrameLosses lost_;
  std::uint64_t number_;
  std::int64_t last_sign_ns_ = 0, last_exposed_ns_ = 0;
};

}  // namespace handcast::camera::leap
