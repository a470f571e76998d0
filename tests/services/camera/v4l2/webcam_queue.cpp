// SPDX-License-Identifier: Apache-2.0
// The queue of buffers: what videobuf2 checks, and in which state it leaves a buffer.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "tests/services/camera/v4l2/webcam_kernel.hpp"

namespace handcast::test {
namespace {

constexpr std::uint32_t kMostBuffers = 32, kLeastBuffers = 2;
constexpr std::uint32_t kBufferSpace = 4 << 20;  ///< from buffer to buffer in the memory

}  // namespace

int EmulatedWebcam::Kernel::refuse() {
  ++misuses_;
  return -EINVAL;
}

bool EmulatedWebcam::Kernel::is_wrong(const v4l2_buffer& buffer) const {
  return buffer.type != V4L2_BUF_TYPE_VIDEO_CAPTURE || buffer.index >= buffers_.size();
}

/// Drops the buffers, as when their file is closed.
void EmulatedWebcam::Kernel::release() {
  streams_ = false;
  owner_ = -1;
  buffers_.clear();
  queued_.clear();
  done_.clear();
  changed_.notify_all();
}

int EmulatedWebcam::Kernel::request(int fd, v4l2_requestbuffers& wanted) {
  if (is_of_another(fd)) return -EBUSY;
  if (wanted.type != V4L2_BUF_TYPE_VIDEO_CAPTURE || wanted.memory != V4L2_MEMORY_MMAP)
    return refuse();
  if (streams_) return -EBUSY;
  release();
  if (wanted.count == 0) return 0;
  if (format_.sizeimage == 0 || format_.sizeimage > kBufferSpace) return -ENOMEM;
  wanted.count = std::clamp(wanted.count, kLeastBuffers, kMostBuffers);
  wanted.capabilities = V4L2_BUF_CAP_SUPPORTS_MMAP;
  if (ftruncate(memory_, std::int64_t{kBufferSpace} * kMostBuffers) != 0) return -ENOMEM;
  owner_ = fd;
  buffers_.assign(wanted.count, {});
  return 0;
}

void EmulatedWebcam::Kernel::fill_in(const Buffer& from, std::uint32_t index,
                                     v4l2_buffer& to) const {
  to.index = index;
  to.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  to.memory = V4L2_MEMORY_MMAP;
  to.m.offset = index * kBufferSpace;
  to.length = format_.sizeimage;
  to.bytesused = from.bytes_used;
  to.sequence = from.sequence;
  to.timestamp = from.stamp;
  to.field = description_.field;
  to.flags = from.flags | V4L2_BUF_FLAG_MAPPED;
  if (from.state == State::queued) to.flags |= V4L2_BUF_FLAG_QUEUED;
  if (from.state == State::done) to.flags |= V4L2_BUF_FLAG_DONE;
}

int EmulatedWebcam::Kernel::query(v4l2_buffer& buffer) {
  if (is_wrong(buffer)) return refuse();
  fill_in(buffers_[buffer.index], buffer.index, buffer);
  return 0;
}

int EmulatedWebcam::Kernel::queue(int fd, v4l2_buffer& buffer) {
  if (is_of_another(fd)) return -EBUSY;
  if (is_wrong(buffer) || buffer.memory != V4L2_MEMORY_MMAP) return refuse();
  auto& own = buffers_[buffer.index];
  if (own.state != State::dequeued) return refuse();
  own = {.state = State::queued};
  queued_.push_back(buffer.index);
  // From now on the driver may write to it.
  std::fill_n(bytes_ + std::size_t{buffer.index} * kBufferSpace, format_.sizeimage,
              std::uint8_t{0xdb});
  fill_in(own, buffer.index, buffer);
  return 0;
}

int EmulatedWebcam::Kernel::dequeue(int fd, v4l2_buffer& buffer) {
  if (is_of_another(fd)) return -EBUSY;
  if (buffer.type != V4L2_BUF_TYPE_VIDEO_CAPTURE || buffer.memory != V4L2_MEMORY_MMAP || !streams_)
    return refuse();
  if (faults_.stops) return -EIO;
  if (done_.empty()) return -EAGAIN;
  const auto index = done_.front();
  done_.pop_front();
  buffers_[index].state = State::dequeued;
  fill_in(buffers_[index], index, buffer);
  return 0;
}

int EmulatedWebcam::Kernel::start(int fd, int type) {
  if (type != V4L2_BUF_TYPE_VIDEO_CAPTURE || buffers_.empty()) return refuse();
  if (is_of_another(fd)) return -EBUSY;
  if (faults_.stream_fails != 0) return -faults_.stream_fails;
  if (!streams_) ++streams_begun_;
  streams_ = true;
  sequence_ = 0;
  changed_.notify_all();
  return 0;
}

int EmulatedWebcam::Kernel::stop(int fd, int type) {
  if (type != V4L2_BUF_TYPE_VIDEO_CAPTURE) return refuse();
  if (is_of_another(fd)) return -EBUSY;
  streams_ = false;
  queued_.clear();
  done_.clear();
  for (auto& buffer : buffers_) buffer.state = State::dequeued;
  changed_.notify_all();
  return 0;
}

int EmulatedWebcam::Kernel::map(int fd, std::size_t length, std::int64_t offset) {
  const std::lock_guard lock(mutex_);
  if (gone_.contains(fd)) return -ENODEV;
  const bool is_a_buffer = offset >= 0 && offset % kBufferSpace == 0 &&
                           offset / kBufferSpace < static_cast<std::int64_t>(buffers_.size());
  if (!is_a_buffer || length > format_.sizeimage) return refuse();
  return memory_;
}

short EmulatedWebcam::Kernel::poll(int fd, short events, std::int64_t until_ns) {
  std::unique_lock lock(mutex_);
  const auto now = [&]() -> short {
    if (gone_.contains(fd)) return POLLERR | POLLHUP | POLLPRI;
    if (!streams_ || faults_.stops) return POLLERR;
    return static_cast<short>(done_.empty() ? 0 : events & (POLLIN | POLLRDNORM));
  };
  const std::chrono::steady_clock::time_point until{std::chrono::nanoseconds(until_ns)};
  changed_.wait_until(lock, until, [&] { return now() != 0; });
  return now();
}

}  // namespace handcast::test
