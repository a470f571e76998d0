// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/trackers_leap_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace handcast::bench {
namespace {

using test::LeapModel;

constexpr std::int64_t kDeadline_ns = 20'000'000;
/// Tells the images of two starts of the stream apart.
constexpr std::uint32_t kPerStart = 1'000'000;
constexpr std::size_t kPixels = std::size_t{WatchedLeap::kWidth} * WatchedLeap::kHeight;

msg::CameraFrame& frame_in(std::vector<std::byte>& memory) {
  return *reinterpret_cast<msg::CameraFrame*>(memory.data());
}

std::uint32_t number_in(const msg::CameraFrame& frame) {
  std::uint32_t number = 0;
  for (int i = 3; i >= 0; --i) number = number << 8 | frame.pixels()[i];
  return number;
}

/// How long this thread has been ready while other work had the processors.
std::int64_t waited_ns() {
  std::ifstream file("/proc/thread-self/schedstat");
  std::int64_t ran_ns = 0, waited_ns = 0;
  file >> ran_ns >> waited_ns;
  return waited_ns;
}

}  // namespace

WatchedLeap::WatchedLeap()
    : device_([](LeapModel& model) { model.numbers_per_start = kPerStart; }),
      first_(msg::CameraFrame::bytes(kWidth, kHeight)),
      second_(first_.size()) {
  rig_.camera.backend = "leap";
  rig_.camera.rate_hz = 115;
  rig_.camera.exposure_ms = 2;
  calibration_.camera.width_px = kWidth;
  calibration_.camera.height_px = kHeight;
}

bool WatchedLeap::open() {
  auto opened = camera::open_camera(rig_, calibration_, now_ns());
  if (opened) {
    camera_ = std::move(*opened);
    return true;
  }
  fmt::print("leap: not measured: {}\n", opened.error().what);
  return false;
}

bool WatchedLeap::is_whole(std::uint32_t number) const {
  const auto is_all = [](const std::vector<std::byte>& memory, std::uint8_t value) {
    const auto* pixels = reinterpret_cast<const msg::CameraFrame*>(memory.data())->pixels();
    return std::all_of(pixels + 4, pixels + kPixels,
                       [value](std::uint8_t pixel) { return pixel == value; });
  };
  return is_all(first_, LeapModel::left_of(number)) && is_all(second_, LeapModel::right_of(number));
}

void WatchedLeap::capture() {
  auto& frame = frame_in(first_);
  const auto waited_before_ns = waited_ns();
  const auto deadline = Deadline::in(std::chrono::nanoseconds(kDeadline_ns));
  const auto captured = camera_->capture_both(frame, frame_in(second_), kPixels, deadline);
  const auto returned_ns = now_ns();
  const auto late_ns = returned_ns - deadline.time_ns();
  seen_.latest_ms = std::max(seen_.latest_ms, ns_to_ms(late_ns));
  seen_.latest_own_ms =
      std::max(seen_.latest_own_ms, ns_to_ms(late_ns - (waited_ns() - waited_before_ns)));
  if (!captured) return;
  const auto number = number_in(frame);
  const auto& lost = frame.lost;
  const std::uint64_t counted = lost.missing + lost.incomplete + lost.underrun + lost.skipped;
  ++seen_.images;
  seen_.damaged += !is_whole(number);
  seen_.counted += counted;
  seen_.lost.missing += lost.missing;
  seen_.lost.incomplete += lost.incomplete;
  seen_.lost.skipped += lost.skipped;
  if (has_last_ && number / kPerStart == last_ / kPerStart)
    seen_.uncounted += static_cast<std::uint64_t>(std::abs(
        static_cast<std::int64_t>(number - last_ - 1) - static_cast<std::int64_t>(counted)));
  const auto next_ns =
      device_.with_model([&](const LeapModel& model) { return model.begun_ns(number + 1); });
  seen_.late_ms.push_back(ns_to_ms(returned_ns - next_ns));
  has_last_ = true;
  last_ = number;
}

}  // namespace handcast::bench
