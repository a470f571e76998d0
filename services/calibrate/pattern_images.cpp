// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/pattern_images.hpp"

#include <algorithm>

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr int kToggles = 20;
constexpr auto kHold = 240ms;

double mean_of(const msg::CameraFrame& frame) {
  constexpr std::size_t kEvery = 7;  // pixels; coprime to the widths of images
  const std::size_t count = std::size_t{frame.width_px} * frame.height_px;
  double sum = 0;
  for (std::size_t i = 0; i < count; i += kEvery) sum += frame.pixels()[i];
  return sum * kEvery / static_cast<double>(std::max<std::size_t>(count, 1));
}

}  // namespace

Result<PatternImages> PatternImages::open(Desk& desk) {
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  return PatternImages(desk, std::move(*frames));
}

void PatternImages::show_level(std::uint8_t level) {
  const auto count = static_cast<std::size_t>(desk_.screen.width_px()) *
                     static_cast<std::size_t>(desk_.screen.height_px());
  desk_.screen.show([&](std::uint8_t* levels) { std::fill_n(levels, count, level); });
}

Result<calib::LightDelay> PatternImages::measure_delay() {
  std::vector<calib::Toggle> toggles;
  std::vector<calib::Brightness> images;
  for (int i = 0; i < kToggles; ++i) {
    if (auto runs = desk_.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
    const bool is_bright = i % 2 == 0;
    // Times that are no multiple of the camera's period meet its exposures everywhere.
    const auto until = Deadline::in(kHold + i * 3ms);
    show_level(is_bright ? 255 : 0);
    const auto lit_ns = desk_.screen.lit_ns(Deadline::in(2s));
    if (!lit_ns) return tl::make_unexpected(lit_ns.error());
    const auto half_ns = seconds_to_ns(0.5 / desk_.rig.projector.rate_hz);
    toggles.push_back({*lit_ns - half_ns, is_bright});
    while (const auto frame = frames_.next(until))
      images.push_back({(*frame)->header.origin_ns, (*frame)->exposure_ns, mean_of(**frame)});
  }
  auto delay = calib::fit_light_delay(toggles, images);
  if (delay)
    settled_ns_ = std::max<std::int64_t>(0, ms_to_ns(delay->high_ms)) +
                  seconds_to_ns(1 / desk_.rig.projector.rate_hz + 2 / desk_.rig.camera.rate_hz);
  return delay;
}

Result<PatternImages::Image> PatternImages::image(
    const std::function<void(std::uint8_t* levels)>& draw) {
  if (auto runs = desk_.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
  desk_.screen.show(draw);
  const auto lit_ns = desk_.screen.lit_ns(Deadline::in(2s));
  if (!lit_ns) return tl::make_unexpected(lit_ns.error());
  for (const auto until = Deadline::in(2s);;) {
    const auto frame = frames_.latest(until);
    if (!frame) return tl::make_unexpected(frame.error());
    desk_.screen.keep();
    const msg::CameraFrame& seen = **frame;
    if (seen.header.origin_ns - seen.exposure_ns / 2 >= *lit_ns + settled_ns_)
      return Image(seen.pixels(), seen.pixels() + std::size_t{seen.width_px} * seen.height_px);
  }
}

}  // namespace handcast::calibrate
