// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "services/tools/init/rig_text.hpp"

namespace handcast::init {
namespace {

std::string camera_of(const Plan& plan) {
  if (!plan.camera.is_device()) return "the digital twin";
  const auto images = images_of(plan);
  auto text = fmt::format("{}, {}{}x{}", plan.camera.device.name,
                          images->format.empty() ? "" : images->format + " ", images->size.width_px,
                          images->size.height_px);
  if (images->rate_hz > 0) text += fmt::format(" at {:.4g} Hz", images->rate_hz);
  return text;
}

std::string light_of(const Plan& plan) {
  if (plan.light.is_device())
    return fmt::format("{}, {:.4g} Hz", plan.light.device.name, showing_of(plan).rate_hz);
  return plan.light.backend == "file" ? "pictures in the folder light/" : "the digital twin";
}

std::string tracker_of(const Plan& plan) {
  if (plan.tracker == Tracker::twin) return "the digital twin's";
  if (plan.tracker != Tracker::none) return plan.tracker_name;
  return fmt::format("none; the hand is {:g} m from the camera", plan.distance_m);
}

std::string calibration_of(const Plan& plan) {
  if (plan.calibration) return plan.calibration_file.string();
  return plan.needs_calibration() ? "MISSING" : "that of the reference rig";
}

std::string controller_of(const Plan& plan) {
  const auto& device = plan.controller->device;
  auto text = fmt::format("{}, video, LEDs at 5 %", device.name);
  if (!device.trouble.empty()) text += "; cannot be used now: " + device.trouble;
  return text;
}

/// The unit of Debian's package runs the rig files of one folder.
std::string start_command(const std::string& file) {
  const auto whole = std::filesystem::absolute(file);
  if (whole.parent_path() != "/etc/handcast")
    return fmt::format("handcast up {}", shell_word(file));
  return fmt::format("sudo systemctl enable --now handcast@{}", whole.stem().string());
}

/// The sentences about what has to be done, in their order.
std::vector<std::string> steps(const Plan& plan, const std::string& file) {
  std::vector<std::string> steps;
  if (plan.needs_calibration())
    steps.push_back(fmt::format(
        "{}\n     Until then the light misses the hand, and `handcast doctor` reports it.",
        calibrate_command(plan, file)));
  if (plan.controller)
    steps.push_back(
        "Read \"A DLP projector with a controller\" in docs/operating/light.md before the "
        "first light.");
  steps.push_back(fmt::format("handcast doctor {}", shell_word(file)));
  steps.push_back(start_command(file));
  return steps;
}

}  // namespace

std::string troubles_of(const std::vector<devices::Attached>& attached) {
  const auto has_another = [&](const devices::Attached& device) {
    return std::ranges::any_of(attached, [&](const devices::Attached& other) {
      return other.kind == device.kind && other.trouble.empty();
    });
  };
  std::string text;
  for (const auto& device : attached)
    if (!device.trouble.empty() && !has_another(device))
      text += fmt::format("cannot be used now: {}: {}\n", device.name, device.trouble);
  return text;
}

std::string report(const Plan& plan, const std::filesystem::path& file) {
  auto text = fmt::format("wrote {}, the rig '{}'\n", file.string(), plan.name);
  const auto line = [&](const char* what, const std::string& chosen) {
    text += fmt::format("  {:<11}  {}\n", what, chosen);
  };
  line("camera", camera_of(plan));
  line("tracker", tracker_of(plan));
  line("light", light_of(plan));
  if (plan.controller) line("controller", controller_of(plan));
  line("calibration", calibration_of(plan));
  text += "next\n";
  int number = 0;
  for (const auto& step : steps(plan, file.string()))
    text += fmt::format("  {}. {}\n", ++number, step);
  return text;
}

}  // namespace handcast::init
