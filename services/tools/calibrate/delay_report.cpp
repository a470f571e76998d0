// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/delay_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/number_text.hpp"

namespace handcast::calibrate {
namespace {

constexpr double kNoticeable_ms = 0.3, kMuchUnseen_ms = 1;
constexpr double kPrinted_ms = 0.05;  ///< less is printed as 0.0

std::string measured(const calib::LightDelay& delay) {
  return fmt::format("{} ms ({} to {}, 95 %)", signed_text(delay.delay_ms, 1),
                     signed_text(delay.low_ms, 1), signed_text(delay.high_ms, 1));
}

}  // namespace

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
