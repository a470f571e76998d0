// SPDX-License-Identifier: Apache-2.0
// The images of the emulated camera.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>

#include "tests/services/camera/v4l2/webcam_kernel.hpp"

namespace handcast::test {
namespace {

constexpr std::size_t kImageSpace = 4 << 20, kMemory = 32 * kImageSpace;

std::int64_t now_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

timeval timeval_of(std::int64_t time_ns) {
  return {time_ns / 1'000'000'000, time_ns % 1'000'000'000 / 1000};
}

}  // namespace

EmulatedWebcam::Kernel::Kernel(Description description)
    : description_(std::move(description)), controls_(description_.controls) {
  memory_ = memfd_create("webcam", MFD_CLOEXEC);
  if (ftruncate(memory_, kMemory) != 0) std::abort();
  bytes_ = static_cast<std::uint8_t*>(
      mmap(nullptr, kMemory, PROT_READ | PROT_WRITE, MAP_SHARED, memory_, 0));
  films_ = std::thread([this] { film(); });
}

EmulatedWebcam::Kernel::~Kernel() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    changed_.notify_all();
  }
  films_.join();
  munmap(bytes_, kMemory);
  ::close(memory_);
}

std::int64_t EmulatedWebcam::Kernel::exposure_ns() {
  const auto* control = control_of(V4L2_CID_EXPOSURE_ABSOLUTE);
  return control == nullptr ? 1'000'000 : control->value * 100'000;
}

/// Takes images at the camera's rate from the start of the stream on.
void EmulatedWebcam::Kernel::film() {
  std::unique_lock lock(mutex_);
  int stream = 0;  // one that was stopped and started again is another one
  const auto films = [&] { return streams_ && streams_begun_ == stream && !is_ending_; };
  const auto sleep_until = [&](std::int64_t time_ns) {
    changed_.wait_until(lock,
                        std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)),
                        [&] { return !films(); });
  };
  while (!is_ending_) {
    changed_.wait(lock, [&] { return streams_ || is_ending_; });
    stream = streams_begun_;
    const std::int64_t start_ns = (now_ns() / 1000 + 1000) * 1000;
    for (std::int64_t number = 0; films(); ++number) {
      const std::int64_t exposed_ns = start_ns + number * (1'000'000'000 / rate_hz_);
      const std::int64_t arrived_ns = exposed_ns + exposure_ns() + description_.transfer_ns;
      sleep_until(arrived_ns);
      if (films() && !faults_.is_silent) send(exposed_ns, arrived_ns);
    }
  }
}

void EmulatedWebcam::Kernel::send(std::int64_t exposed_ns, std::int64_t arrived_ns) {
  const auto sequence = sequence_++;
  if (to_lose_ > 0) {
    --to_lose_;
    return;
  }
  if (queued_.empty()) return;
  const auto index = queued_.front();
  queued_.pop_front();
  auto& buffer = buffers_[index];
  const auto bytes = image(sequence);
  const bool is_broken = to_break_ > 0;
  if (is_broken) --to_break_;
  const bool is_of_start =
      (description_.stamps & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  const auto stamp_ns = (is_of_start ? exposed_ns : arrived_ns) + faults_.stamps_late_ns;
  buffer = {.state = State::done,
            .bytes_used = static_cast<std::uint32_t>(bytes.size() / (is_broken ? 2 : 1)),
            .flags = description_.stamps | (is_broken ? V4L2_BUF_FLAG_ERROR : 0u),
            .sequence = faults_.does_not_count ? 0 : sequence,
            .stamp = timeval_of(stamp_ns)};
  std::copy_n(bytes.begin(), buffer.bytes_used, bytes_ + index * kImageSpace);
  done_.push_back(index);
  sent_.push_back({sequence, exposed_ns, arrived_ns});
  changed_.notify_all();
}

std::vector<std::uint8_t> EmulatedWebcam::Kernel::image(std::uint32_t sequence) const {
  if (image_) return image_(sequence);
  const auto grey = static_cast<std::uint8_t>(10 + sequence % 100);
  std::vector<std::uint8_t> bytes(format_.sizeimage, 0xee);
  for (std::uint32_t y = 0; y < format_.height; ++y)
    for (std::uint32_t x = 0; x < format_.width; ++x) {
      auto* row = bytes.data() + std::size_t{y} * format_.bytesperline;
      switch (format_.pixelformat) {
        case V4L2_PIX_FMT_Y16:
          row[2 * x + 1] = grey;
          break;
        case V4L2_PIX_FMT_Y10:
          row[2 * x] = static_cast<std::uint8_t>(grey << 2);
          row[2 * x + 1] = grey >> 6;
          break;
        case V4L2_PIX_FMT_YUYV:
          row[2 * x] = grey;
          break;
        default:
          row[x] = grey;
      }
    }
  return bytes;
}

}  // namespace handcast::test
