// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/display.hpp"

#include <fmt/format.h>

#include <cmath>
#ifdef HANDCAST_WITH_WINDOW
#include "renderer/window/monitor.hpp"
#include "renderer/window/window.hpp"
#endif
#ifdef HANDCAST_WITH_KMS
#include "renderer/kms/card.hpp"
#endif

namespace handcast::doctor {
namespace {

constexpr double kSameRate = 0.01;  ///< share; 59.94 Hz is 60 Hz

[[maybe_unused]] Result<DisplayMode> mode_of_window(const config::Rig& rig) {
#ifdef HANDCAST_WITH_WINDOW
  const auto monitors = renderer::list_monitors();
  if (!monitors) return tl::make_unexpected(monitors.error());
  const auto chosen = renderer::choose_monitor(*monitors, rig.projector.window.monitor);
  if (!chosen) return tl::make_unexpected(chosen.error());
  const auto& monitor = (*monitors)[*chosen];
  return DisplayMode{renderer::describe(monitor, *chosen), monitor.width_px, monitor.height_px,
                     monitor.rate_hz};
#else
  return fail(Errc::bad_config, "this build has no back end 'window'");
#endif
}

[[maybe_unused]] Result<DisplayMode> mode_of_connector(const config::Rig& rig,
                                                       const calib::Calibration& calibration) {
#ifdef HANDCAST_WITH_KMS
  using namespace renderer::kms;
  const auto& kms = rig.projector.kms;
  const auto found = find_display(kms.card, kms.connector);
  if (!found) return tl::make_unexpected(found.error());
  const auto& display = found->display;
  const auto chosen = choose_mode(display.modes, kms.mode,
                                  {.width_px = calibration.projector_width_px,
                                   .height_px = calibration.projector_height_px,
                                   .rate_hz = rig.projector.rate_hz});
  if (!chosen) return tl::make_unexpected(chosen.error());
  const auto& mode = display.modes[*chosen];
  return DisplayMode{describe(display), mode.width_px, mode.height_px, mode.rate_hz};
#else
  return fail(Errc::bad_config, "this build has no back end 'kms'");
#endif
}

}  // namespace

std::vector<Finding> judge_mode(const DisplayMode& mode, const config::Projector& projector,
                                const calib::Calibration& calibration) {
  std::vector<Finding> findings;
  const int width_px = calibration.projector_width_px, height_px = calibration.projector_height_px;
  if (mode.width_px == width_px && mode.height_px == height_px)
    findings.push_back({"display", Grade::good, mode.display, ""});
  else
    findings.push_back({"display",
                        projector.packing == config::Packing::none ? Grade::advice : Grade::fault,
                        fmt::format("{} has {}x{} pixels and the calibration {}x{}", mode.display,
                                    mode.width_px, mode.height_px, width_px, height_px),
                        projector.packing == config::Packing::none
                            ? "give the display the calibrated mode; a scaled picture is blurred"
                            : "give the display the calibrated mode; sub-frames cannot be scaled"});
  if (mode.rate_hz > 0 && std::abs(mode.rate_hz - projector.rate_hz) > kSameRate * mode.rate_hz)
    findings.push_back({"display rate", Grade::advice,
                        fmt::format("the display refreshes at {:.2f} Hz, and projector.rate_hz is "
                                    "{:g}",
                                    mode.rate_hz, projector.rate_hz),
                        fmt::format("set projector.rate_hz = {:.2f}", mode.rate_hz)});
  return findings;
}

std::vector<Finding> examine_display(const config::Rig& rig,
                                     const calib::Calibration& calibration) {
  const auto& projector = rig.projector;
  const bool is_monitor = projector.backend == "window" && projector.window.full_screen;
  if (!is_monitor && projector.backend != "kms") return {};
  const auto mode = is_monitor ? mode_of_window(rig) : mode_of_connector(rig, calibration);
  if (!mode)
    return {{"display", Grade::fault, mode.error().what,
             "`handcast devices` lists the displays that are there"}};
  return judge_mode(*mode, projector, calibration);
}

}  // namespace handcast::doctor
