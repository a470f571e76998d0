// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/light_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/number_text.hpp"
#include "services/tools/calibrate/sound/sound_card.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr int kToggles = 24;
constexpr double kHold_s = 0.24, kCardDelay_ms = 2;
constexpr double kNoticeable_ms = 0.3, kMuchUnseen_ms = 1;
constexpr double kPrinted_ms = 0.05;  ///< less is printed as 0.0

std::string measured(const calib::LightDelay& delay) {
  return fmt::format("{} ms ({} to {}, 95 %)", signed_text(delay.delay_ms, 1),
                     signed_text(delay.low_ms, 1), signed_text(delay.high_ms, 1));
}

/// Toggles the light.
Result<std::vector<calib::Toggle>> toggle(Desk& desk) {
  std::vector<calib::Toggle> toggles;
  for (int i = 0; i < kToggles; ++i) {
    if (auto runs = desk.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
    const bool is_bright = i % 2 == 0;
    const auto until_ns = now_ns() + seconds_to_ns(kHold_s);
    desk.screen.show_level(is_bright ? 255 : 0);
    const auto light = desk.screen.first_light(Deadline::in(2s));
    if (!light) return tl::make_unexpected(light.error());
    toggles.push_back({light->middle_ns - light->period_ns / 2, is_bright, light->is_sure});
    sleep_until_ns(until_ns);
  }
  return toggles;
}

}  // namespace

Result<calib::LightDelay> measure_delay_by_sound(Desk& desk) {
  auto card = open_sound_card(desk.options.photodiode);
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

void report_delay(const config::Rig& rig, const calib::LightDelay& delay, Outcome& outcome) {
  const auto& backend = rig.projector.backend;
  const double latency_ms = rig.projector.latency_ms + delay.delay_ms;
  const bool is_known = delay.low_ms < kPrinted_ms && delay.high_ms > -kPrinted_ms;
  if (is_known || std::abs(delay.delay_ms) < kNoticeable_ms) {
    outcome.findings.push_back(
        fmt::format("the light of '{}' comes when it is reported: {}", backend, measured(delay)));
  } else if (latency_ms < 0) {
    outcome.findings.push_back(fmt::format(
        "the light of '{}' seems to come {}, which is before it is handed over: the time stamps of "
        "the camera are late, see camera.delivery_ms in docs/operating/cameras.md",
        backend, measured(delay)));
  } else {
    outcome.findings.push_back(
        fmt::format("the light of '{}' comes {} after the reported time: set projector.latency_ms "
                    "= {:.1f}, for which every frame is drawn",
                    backend, measured(delay), latency_ms));
    outcome.settings.push_back({"projector.latency_ms", fmt::format("{:.1f}", latency_ms)});
  }
  if (delay.unseen_ms > kMuchUnseen_ms)
    outcome.findings.push_back(
        fmt::format("{:.1f} ms of that interval are gaps between exposures into which every change "
                    "of the light "
                    "fell: a longer camera.exposure_ms, or a camera.rate_hz that does not divide "
                    "projector.rate_hz, makes this measurement more exact",
                    delay.unseen_ms));
}

}  // namespace handcast::calibrate
