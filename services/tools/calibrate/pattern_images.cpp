// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pattern_images.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

/// Changes of the light: the first ones are far apart, because any delay is possible.
/// @{
constexpr int kFirstToggles = 16, kMoreToggles = 20;
constexpr std::size_t kMostToggles = 76;
constexpr double kFirstHold_s = 0.24, kLeastHold_s = 0.08;
/// @}
constexpr double kGoodInterval_ms = 0.6;  ///< whole width; more changes do not make it narrower

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

/// Changes the light `count` times, at least `hold_s` apart, and watches.
Result<void> PatternImages::toggle(int count, double hold_s, Watched& watched) {
  for (int i = 0; i < count; ++i) {
    if (auto runs = desk_.own_rig.check(); !runs) return runs;
    const bool is_bright = i % 2 == 0;
    // Times that are no multiple of the camera's period meet its exposures everywhere.
    const auto until = Deadline::at_ns(now_ns() + seconds_to_ns(hold_s + 0.0031 * (i % 7)));
    desk_.screen.show_level(is_bright ? 255 : 0);
    const auto light = desk_.screen.first_light(Deadline::in(2s));
    if (!light) return tl::make_unexpected(light.error());
    period_ns_ =
        light->period_ns > 0 ? light->period_ns : seconds_to_ns(1 / desk_.rig.projector.rate_hz);
    watched.toggles.push_back({light->middle_ns - period_ns_ / 2, is_bright, light->is_sure});
    while (const auto frame = frames_.next(until)) {
      const msg::CameraFrame& seen = **frame;
      watched.images.push_back(
          {seen.header.origin_ns, seen.exposure_ns, mean_of(seen), seen.origin_error_ns});
    }
  }
  return {};
}

Result<calib::LightDelay> PatternImages::measure_delay() { return measure_delay(kMostToggles); }
Result<calib::LightDelay> PatternImages::measure_delay_roughly() {
  return measure_delay(kFirstToggles);
}

/// For how long a change must be held to be seen.
double PatternImages::hold_s_of(const calib::LightDelay& delay) const {
  const double longest_s = 1e-3 * std::max(std::abs(delay.low_ms), std::abs(delay.high_ms));
  return std::max(kLeastHold_s, 2.5 * longest_s + 4 / desk_.rig.camera.rate_hz);
}

Result<calib::LightDelay> PatternImages::measure_delay(std::size_t most_toggles) {
  Watched watched;
  if (auto done = toggle(kFirstToggles, kFirstHold_s, watched); !done)
    return tl::make_unexpected(done.error());
  auto delay = calib::fit_light_delay(watched.toggles, watched.images);
  // Of a busy computer, more changes are needed until enough were seen.
  const auto needs_more = [&] {
    return delay ? delay->high_ms - delay->low_ms > kGoodInterval_ms
                 : delay.error().code == Errc::unavailable;
  };
  while (needs_more() && watched.toggles.size() < (delay ? most_toggles : kMostToggles)) {
    const double hold_s = delay ? hold_s_of(*delay) : kFirstHold_s;
    if (auto done = toggle(kMoreToggles, hold_s, watched); !done)
      return tl::make_unexpected(done.error());
    delay = calib::fit_light_delay(watched.toggles, watched.images);
  }
  if (delay)
    settled_ns_ = std::max<std::int64_t>(0, ms_to_ns(delay->high_ms)) + period_ns_ +
                  seconds_to_ns(2 / desk_.rig.camera.rate_hz);
  return delay;
}

Result<PatternImages::Image> PatternImages::image_of_level(std::uint8_t level) {
  return image_after([&] { desk_.screen.show_level(level); });
}

Result<PatternImages::Image> PatternImages::image(
    const std::function<void(std::uint8_t* levels)>& draw) {
  return image_after([&] { desk_.screen.show(draw); });
}

/// The image after `show` has shown a picture.
Result<PatternImages::Image> PatternImages::image_after(const std::function<void()>& show) {
  if (auto runs = desk_.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
  show();
  const auto light = desk_.screen.first_light(Deadline::in(2s));
  if (!light) return tl::make_unexpected(light.error());
  for (const auto until = Deadline::in(2s);;) {
    const auto frame = frames_.latest(until);
    if (!frame) return tl::make_unexpected(frame.error());
    desk_.screen.keep();
    const msg::CameraFrame& seen = **frame;
    if (seen.header.origin_ns - seen.exposure_ns / 2 >= light->middle_ns + settled_ns_)
      return Image(seen.pixels(), seen.pixels() + std::size_t{seen.width_px} * seen.height_px);
  }
}

}  // namespace handcast::calibrate
