// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/mailbox.hpp"

#include <chrono>
#include <utility>

namespace handcast::camera::leap {

void Mailbox::advance(const msg::FrameLosses& lost, std::uint64_t steps) {
  number_ += has_begun_ ? steps : steps - 1;
  has_begun_ = true;
  last_sign_ns_ = now_ns();
  lost_.missing += lost.missing;
  lost_.incomplete += lost.incomplete;
}

void Mailbox::put(StereoImage& image, std::uint64_t steps) {
  {
    const std::scoped_lock lock(mutex_);
    advance(image.lost, steps);
    lost_.skipped += is_full_;
    image.number = number_;
    last_exposed_ns_ = image.exposed_ns;
    std::swap(newest_, image);
    is_full_ = true;
  }
  came_.notify_one();
}

void Mailbox::count(const msg::FrameLosses& lost, std::uint64_t steps) {
  const std::scoped_lock lock(mutex_);
  advance(lost, steps);
}

bool Mailbox::take(StereoImage& image, Deadline deadline) {
  const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
  std::unique_lock lock(mutex_);
  if (!came_.wait_until(lock, until, [this] { return is_full_; })) return false;
  std::swap(newest_, image);
  is_full_ = false;
  image.lost = std::exchange(lost_, {});
  return true;
}

std::int64_t Mailbox::last_sign_ns() const {
  const std::scoped_lock lock(mutex_);
  return last_sign_ns_;
}

std::int64_t Mailbox::last_exposed_ns() const {
  const std::scoped_lock lock(mutex_);
  return last_exposed_ns_;
}

}  // namespace handcast::camera::leap
