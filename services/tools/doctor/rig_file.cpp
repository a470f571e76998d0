// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/rig_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "calib/sub_frames.hpp"
#include "config/second_view.hpp"

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
                                  {.width_px = calibration.projector.width_px,
                                   .height_px = calibration.projector.height_px,
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
  const int width_px = calibration.projector.width_px, height_px = calibration.projector.height_px;
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

/// A window among others needs no monitor of its own.
static std::vector<Finding> examine_window_system() {
#ifdef HANDCAST_WITH_WINDOW
  if (const auto monitors = renderer::list_monitors(); !monitors)
    return {{"display", Grade::fault, monitors.error().what,
             "start it in a desktop session, or choose the back end kms"}};
  return {{"display", Grade::good, "a window system answers", ""}};
#else
  return {{"display", Grade::fault, "this build has no back end 'window'",
           "`handcast config --check`"}};
#endif
}

std::vector<Finding> examine_display(const config::Rig& rig,
                                     const calib::Calibration& calibration) {
  const auto& projector = rig.projector;
  const bool is_window = projector.backend == "window";
  if (!is_window && projector.backend != "kms") return {};
  if (is_window && !projector.window.full_screen) return examine_window_system();
  const auto mode = is_window ? mode_of_window(rig) : mode_of_connector(rig, calibration);
  if (!mode)
    return {{"display", Grade::fault, mode.error().what,
             "`handcast devices` lists the displays that are there"}};
  return judge_mode(*mode, projector, calibration);
}

namespace {

/// Of a rig with two cameras, which the calibration has.
Finding second_camera_of(const calib::Calibration& calibration) {
  const auto& camera = calibration.camera;
  const auto& second = *calibration.camera2;
  const auto& made = calibration.made.pair;
  return {"calibration", Grade::good,
          fmt::format("camera {} x {} px, second camera {} x {} px, {:.0f} mm from it ({}), "
                      "projector {} x {} px",
                      camera.width_px, camera.height_px, second.camera.width_px,
                      second.camera.height_px, 1e3 * glm::length(glm::dvec3(second.from_camera[3])),
                      made.empty() ? "it is not said when that was measured"
                                   : "measured " + made.substr(0, made.find(':')),
                      calibration.projector.width_px, calibration.projector.height_px),
          ""};
}

Finding calibration_of(const config::Rig& rig) {
  const bool is_real = rig.camera.backend != "twin" && rig.camera.backend != "replay";
  if (rig.calibration.empty() && is_real)
    return {"calibration", Grade::fault,
            "a real camera with the calibration of the reference rig: the light will miss the hand",
            "make one with `handcast calibrate RIG.toml --camera WxH --projector WxH --apply`"};
  if (rig.calibration.empty())
    return {"calibration", Grade::good, "that of the reference rig, which the twin has", ""};
  const auto calibration = calib::load_calibration(rig.calibration, {}, rig.projector2);
  if (!calibration)
    return {"calibration", Grade::fault, calibration.error().what, "`handcast config --check`"};
  const bool has_second = config::has_second_view(rig);
  if (has_second && !calibration->camera2)
    return {"calibration", Grade::fault, "the second camera is not calibrated",
            "`handcast calibrate RIG.toml lens2 pair`"};
  if (is_real && calibration->camera_device.empty())
    return {"calibration", Grade::advice,
            "it does not name its camera, so that another one would not be noticed",
            "set [camera] device in it, as `handcast devices` lists the camera"};
  if (has_second) return second_camera_of(*calibration);
  return {"calibration", Grade::good,
          fmt::format("camera {} x {} px, projector {} x {} px", calibration->camera.width_px,
                      calibration->camera.height_px, calibration->projector.width_px,
                      calibration->projector.height_px),
          ""};
}

/// Of a rig with two projectors, which the calibration has.
std::vector<Finding> examine_second_display(const config::Rig& rig,
                                            const calib::Calibration& calibration) {
  constexpr auto kSecond = config::Viewpoint::second;
  auto findings = examine_display(config::rig_at_projector(rig, kSecond),
                                  calib::at_projector(calibration, kSecond));
  for (auto& finding : findings) finding.sentence = "projector2: " + finding.sentence;
  const auto& first = rig.projector;
  const auto& second = rig.projector2;
  const auto both = [&](std::string_view backend) {
    return first.backend == backend && second.backend == backend;
  };
  if (both("window") && first.window.full_screen && first.window.monitor == second.window.monitor)
    findings.push_back({"display", Grade::fault, "both projectors of the rig have one monitor",
                        "name one in projector.window.monitor and the other in "
                        "projector2.window.monitor; `handcast devices` lists them"});
  if (both("kms") && first.kms.card == second.kms.card)
    findings.push_back({"display", Grade::fault,
                        "both projectors of the rig are on one graphics card, which `kms` holds "
                        "for one process",
                        "use the back end `window`, or a card for each (kms.card)"});
  return findings;
}

}  // namespace

std::vector<Finding> examine_file(const Result<config::Rig>& rig) {
  if (!rig)
    return {{"rig file", Grade::fault, rig.error().what,
             "`handcast config --reference` explains all settings"}};
  std::vector<Finding> findings{{"rig file", Grade::good, fmt::format("rig '{}'", rig->name), ""},
                                calibration_of(*rig)};
  const auto calibration = calib::load_calibration(rig->calibration, {}, rig->projector2);
  if (!calibration) return findings;
  for (auto& finding : examine_display(*rig, *calibration)) findings.push_back(std::move(finding));
  if (calibration->projector2)
    for (auto& finding : examine_second_display(*rig, *calibration))
      findings.push_back(std::move(finding));
  return findings;
}

}  // namespace handcast::doctor
