// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/stream.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace handcast::camera::v4l2 {
namespace {

constexpr std::uint32_t kBuffers = 8;  // a driver may share more or fewer
constexpr std::uint32_t kLeastBuffers = 2;

v4l2_buffer buffer_of(std::uint32_t number) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = number;
  return buffer;
}

StampOf stamp_of(std::uint32_t flags) {
  if ((flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
    return StampOf::nothing;
  return (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE
             ? StampOf::exposure_start
             : StampOf::arrival;
}

std::int64_t ns_of(const timeval& time) {
  return (std::int64_t{time.tv_sec} * 1'000'000 + time.tv_usec) * 1000;
}

timespec time_until(Deadline deadline) {
  const std::int64_t span_ns = std::max<std::int64_t>(deadline.time_ns() - now_ns(), 0);
  return {.tv_sec = span_ns / 1'000'000'000, .tv_nsec = span_ns % 1'000'000'000};
}

/// Why a stream does not start.
Error not_started(const Identity& identity, std::string_view what, int number) {
  if (number == ENOSPC)
    return {Errc::unavailable,
            fmt::format("{}: too little USB bandwidth is left; plug the camera into another port "
                        "or set v4l2.format to MJPEG",
                        describe(identity))};
  return error_of(identity, Errc::unavailable, what, number);
}

}  // namespace

Result<std::unique_ptr<Stream>> Stream::start(const Device& device) {
  std::unique_ptr<Stream> stream(new Stream(device));
  if (auto shared = stream->share_buffers(); !shared) return tl::make_unexpected(shared.error());
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int number = call(device.fd.get(), VIDIOC_STREAMON, &type); number != 0)
    return tl::make_unexpected(not_started(device.identity, "the stream does not start", number));
  return stream;
}

Stream::~Stream() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  call(device_.fd.get(), VIDIOC_STREAMOFF, &type);
  for (const auto& buffer : buffers_) munmap(buffer.data(), buffer.size());
  v4l2_requestbuffers none{
      .count = 0, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
  call(device_.fd.get(), VIDIOC_REQBUFS, &none);
}

Result<void> Stream::share_buffers() {
  v4l2_requestbuffers wanted{
      .count = kBuffers, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
  if (const int number = call(device_.fd.get(), VIDIOC_REQBUFS, &wanted); number != 0)
    return tl::make_unexpected(
        not_started(device_.identity, "the driver shares no buffers", number));
  if (wanted.count < kLeastBuffers)
    return fail(Errc::unavailable, fmt::format("{}: the driver has no memory for its images",
                                               describe(device_.identity)));
  for (std::uint32_t number = 0; number < wanted.count; ++number) {
    if (auto mapped = map(number); !mapped) return mapped;
    if (auto queued = queue(number); !queued) return queued;
  }
  return {};
}

Result<void> Stream::map(std::uint32_t number) {
  auto buffer = buffer_of(number);
  if (const int error = call(device_.fd.get(), VIDIOC_QUERYBUF, &buffer); error != 0)
    return tl::make_unexpected(not_started(device_.identity, "a buffer cannot be found", error));
  void* memory = mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_.fd.get(),
                      buffer.m.offset);
  if (memory == MAP_FAILED)
    return tl::make_unexpected(not_started(device_.identity, "a buffer cannot be mapped", errno));
  buffers_.push_back({static_cast<std::uint8_t*>(memory), buffer.length});
  return {};
}

Result<void> Stream::queue(std::uint32_t number) {
  auto buffer = buffer_of(number);
  if (const int error = call(device_.fd.get(), VIDIOC_QBUF, &buffer); error != 0)
    return lost("a buffer cannot be given back", error);
  return {};
}

tl::unexpected<Error> Stream::lost(std::string_view what, int number) const {
  return tl::make_unexpected(error_of(device_.identity, Errc::disconnected, what, number));
}

Result<void> Stream::wait(Deadline deadline) const {
  for (;;) {
    pollfd watched{.fd = device_.fd.get(), .events = POLLIN, .revents = 0};
    const auto span = time_until(deadline);
    const int ready = ppoll(&watched, 1, &span, nullptr);
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) return lost("waiting fails", errno);
    if (ready == 0) return fail(Errc::timeout, "no image before the deadline");
    if ((watched.revents & POLLIN) != 0) return {};
    if ((watched.revents & POLLHUP) != 0) return lost("", ENODEV);
    return fail(Errc::disconnected,
                fmt::format("{}: the driver has ended the stream", describe(device_.identity)));
  }
}

Result<std::optional<Filled>> Stream::take() {
  auto buffer = buffer_of(0);
  const int number = call(device_.fd.get(), VIDIOC_DQBUF, &buffer);
  if (number == EAGAIN) return std::nullopt;
  if (number != 0) return lost("the stream has ended", number);
  if (buffer.index >= buffers_.size())
    return fail(Errc::disconnected, fmt::format("{}: the driver delivers a buffer {} that it does "
                                                "not have",
                                                describe(device_.identity), buffer.index));
  const auto memory = buffers_[buffer.index];
  return Filled{.buffer = buffer.index,
                .sequence = buffer.sequence,
                .is_broken = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0,
                .bytes = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size())),
                .times = {stamp_of(buffer.flags), ns_of(buffer.timestamp), now_ns()}};
}

Result<void> Stream::give_back(const Filled& image) { return queue(image.buffer); }

}  // namespace handcast::camera::v4l2
