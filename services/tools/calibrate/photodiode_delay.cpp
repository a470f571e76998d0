// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/photodiode_delay.hpp"

#include <algorithm>
#include <vector>

#include "services/tools/calibrate/sound/recorder.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr int kToggles = 24;
constexpr double kHold_s = 0.24, kCardDelay_ms = 2;

/// Toggles the light.
Result<std::vector<calib::Toggle>> toggle(Desk& desk) {
  std::vector<calib::Toggle> toggles;
  for (int i = 0; i < kToggles; ++i) {
    if (auto runs = desk.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
    const bool is_bright = i % 2 == 0;
    const auto until_ns = now_ns() + seconds_to_ns(kHold_s);
    const auto count = static_cast<std::size_t>(desk.screen.width_px()) *
                       static_cast<std::size_t>(desk.screen.height_px());
    desk.screen.show([&](std::uint8_t* levels) {
      std::fill_n(levels, count, static_cast<std::uint8_t>(is_bright ? 255 : 0));
    });
    const auto light = desk.screen.first_light(Deadline::in(2s));
    if (!light) return tl::make_unexpected(light.error());
    toggles.push_back({light->middle_ns - light->period_ns / 2, is_bright, light->is_sure});
    sleep_until_ns(until_ns);
  }
  return toggles;
}

}  // namespace

Result<calib::LightDelay> measure_delay_by_sound(Desk& desk, const std::string& device) {
  auto card = open_sound_card(device);
  if (!card) return tl::make_unexpected(card.error());
  Recorder recorder(std::move(*card));
  sleep_until_ns(now_ns() + seconds_to_ns(kHold_s));
  const auto toggles = toggle(desk);
  const auto clip = recorder.finish();
  if (!toggles) return tl::make_unexpected(toggles.error());
  if (!clip) return tl::make_unexpected(clip.error());
  auto delay = calib::fit_sound_delay(*toggles, *clip);
  if (delay) delay->low_ms -= kCardDelay_ms;
  return delay;
}

}  // namespace handcast::calibrate
