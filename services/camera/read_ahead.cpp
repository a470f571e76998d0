// SPDX-License-Identifier: Apache-2.0
#include "services/camera/read_ahead.hpp"

#include <algorithm>
#include <chrono>

namespace handcast::camera {

ReadAhead::ReadAhead(std::unique_ptr<PictureSource> source, std::size_t count, std::size_t bytes,
                     std::uint64_t first)
    : source_(std::move(source)), count_(count), wanted_(first), next_(first) {
  for (auto& slot : slots_) slot.picture.pixels.resize(bytes);
  thread_ = std::thread([this] { run(); });
}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ReadAhead::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || next_ < wanted_ + kSlots; });
    if (ending_) return;
    auto& slot = slots_[next_ % kSlots];
    slot.number = next_++;
    slot.done = false;
    lock.unlock();
    auto result = source_->read(slot.number % count_, slot.picture.frame, slot.picture.pixels);
    lock.lock();
    slot.result = std::move(result);
    slot.done = true;
    changed_.notify_all();
  }
}

Result<const ReadAhead::Picture*> ReadAhead::get(std::uint64_t number, Deadline deadline) {
  std::unique_lock lock(mutex_);
  wanted_ = number;
  next_ = std::max(next_, wanted_);
  changed_.notify_all();
  const auto& slot = slots_[number % kSlots];
  const auto is_there = [&] { return slot.done && slot.number == number; };
  while (!is_there()) {
    const auto left_ns = deadline.time_ns() - now_ns();
    if (left_ns <= 0) return fail(Errc::timeout, "the image has not been read in time");
    changed_.wait_for(lock, std::chrono::nanoseconds(left_ns));
  }
  if (!slot.result) return tl::make_unexpected(slot.result.error());
  return &slot.picture;
}

}  // namespace handcast::camera
