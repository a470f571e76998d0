// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/mailbox.hpp"

#include <chrono>
#include <utility>

namespace handcast::camera::aravis {
namespace {

void add(msg::FrameLosses& sum, const msg::FrameLosses& lost) {
  sum.missing += lost.missing;
  sum.incomplete += lost.incomplete;
  sum.underrun += lost.underrun;
  sum.skipped += lost.skipped;
}

}  // namespace

Image& Image::operator=(Image&& other) noexcept {
  std::swap(stream_, other.stream_);
  std::swap(buffer_, other.buffer_);
  number = other.number;
  exposed_ns = other.exposed_ns;
  exposed_error_ns = other.exposed_error_ns;
  exposure_ns = other.exposure_ns;
  arrived_ns = other.arrived_ns;
  lost = other.lost;
  return *this;
}

Image::~Image() {
  if (buffer_) arv_stream_push_buffer(stream_.get(), buffer_.release());
}

void Mailbox::put(Image image, std::uint64_t steps) {
  std::optional<Image> replaced;  // goes back to its stream after the lock
  {
    const std::scoped_lock lock(mutex_);
    last_arrival_ns_ = image.arrived_ns;
    image.number = number_ += steps;
    add(lost_, image.lost);
    lost_.skipped += newest_.has_value();
    replaced = std::exchange(newest_, std::move(image));
  }
  came_.notify_one();
}

void Mailbox::count(const msg::FrameLosses& lost, std::uint64_t steps) {
  const std::scoped_lock lock(mutex_);
  last_arrival_ns_ = now_ns();
  number_ += steps;
  add(lost_, lost);
}

std::optional<Image> Mailbox::take(Deadline deadline) {
  const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, until, [this] { return newest_.has_value(); });
  auto image = std::exchange(newest_, std::nullopt);
  if (image) image->lost = std::exchange(lost_, {});
  return image;
}

void Mailbox::clear() {
  std::optional<Image> dropped;  // goes back to its stream after the lock
  const std::scoped_lock lock(mutex_);
  lost_.skipped += newest_.has_value();
  std::swap(dropped, newest_);
}

std::int64_t Mailbox::last_arrival_ns() const {
  const std::scoped_lock lock(mutex_);
  return last_arrival_ns_;
}

}  // namespace handcast::camera::aravis
