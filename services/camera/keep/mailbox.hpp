// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::camera {

/// Holds the newest image of a camera until it is taken, and counts those that were lost before it.
/// It outlives the streams that fill it. Any thread.
///
/// `Image` has a default, can be swapped, and has the members
///     std::uint64_t number;     // grows with each exposure, also with one that was lost
///     std::int64_t exposed_ns;  // the middle of the exposure, CLOCK_MONOTONIC
///     msg::FrameLosses lost;    // between the image that was taken before and this one
template <class Image>
class Mailbox {
 public:
  /// `first`: the number of the first image.
  explicit Mailbox(std::uint64_t first) : number_(first) {}

  /// Puts an image there, with `image.lost`, what was lost directly before it. One that is waiting
  /// is replaced, which counts as skipped; `image` gets what was there. `steps`: exposures since
  /// the last image, this one included.
  void put(Image& image, std::uint64_t steps) {
    {
      const std::scoped_lock lock(mutex_);
      advance(image.lost, steps);
      if (is_full_) skip();
      image.number = number_;
      image.lost = std::exchange(lost_, {});
      last_exposed_ns_ = image.exposed_ns;
      std::swap(newest_, image);
      is_full_ = true;
    }
    came_.notify_one();
  }

  /// Counts exposures that did not become an image; `steps` as for put().
  void count(const msg::FrameLosses& lost, std::uint64_t steps) {
    const std::scoped_lock lock(mutex_);
    advance(lost, steps);
  }

  /// Takes the newest image as soon as there is one; what `image` was before stays here. False at
  /// the deadline.
  bool take(Image& image, Deadline deadline) {
    const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
    std::unique_lock lock(mutex_);
    if (!came_.wait_until(lock, until, [this] { return is_full_; })) return false;
    std::swap(newest_, image);
    is_full_ = false;
    return true;
  }

  /// Drops the image that is waiting, which counts as skipped, and what was given back by take().
  void clear() {
    Image dropped;  // destroyed after the lock
    const std::scoped_lock lock(mutex_);
    if (is_full_) skip();
    is_full_ = false;
    std::swap(newest_, dropped);
  }

  /// When the last image came, whole or not; 0 if none has. CLOCK_MONOTONIC. Takes no lock: a
  /// thread without real-time priority that holds one delays the thread of the stream.
  std::int64_t last_sign_ns() const { return last_sign_ns_; }
  /// The middle of the exposure of the last image; 0 if there is none.
  std::int64_t last_exposed_ns() const { return last_exposed_ns_; }

 private:
  void advance(const msg::FrameLosses& lost, std::uint64_t steps) {
    number_ += has_begun_ ? steps : steps - 1;
    has_begun_ = true;
    last_sign_ns_ = now_ns();
    add(lost);
  }
  void add(const msg::FrameLosses& lost) {
    lost_.missing += lost.missing;
    lost_.incomplete += lost.incomplete;
    lost_.underrun += lost.underrun;
    lost_.skipped += lost.skipped;
  }
  void skip() {
    add(newest_.lost);
    ++lost_.skipped;
  }

  std::mutex mutex_;
  std::condition_variable came_;
  Image newest_;
  bool is_full_ = false, has_begun_ = false;
  msg::FrameLosses lost_;  ///< after newest_ if that is full, otherwise after the one before
  std::uint64_t number_;
  std::atomic<std::int64_t> last_sign_ns_ = 0, last_exposed_ns_ = 0;
};

}  // namespace handcast::camera
