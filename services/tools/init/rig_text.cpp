// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/rig_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace handcast::init {
namespace {

constexpr double kUnknownRate_hz = 30;  ///< what any camera has
constexpr double kExposure_ms = 4;
constexpr double kMostOfThePeriod = 0.8;  ///< the rest is for the readout

/// A text as a string of TOML.
std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    const auto code = static_cast<unsigned char>(c);
    quoted += code < 0x20 || code == 0x7f ? fmt::format("\\u{:04X}", code) : std::string(1, c);
  }
  return quoted + '"';
}

/// The path as the rig file names it.
std::string named_in(const std::filesystem::path& file, const std::filesystem::path& named) {
  const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path();
  const auto relative = named.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." ? named.string() : relative.string();
}

std::string text_of(Size size) { return fmt::format("{}x{}", size.width_px, size.height_px); }

std::string head(const Plan& plan, const std::filesystem::path& file) {
  auto text = fmt::format(
      "# A rig file, written by `handcast init`. It says what is likely to be changed; all other "
      "settings have their\n"
      "# defaults, which `handcast config --print {}` shows and config/REFERENCE.md explains.\n",
      one_line(file.filename().string()));
  if (plan.camera.is_device() || plan.light.is_device())
    text += fmt::format(
        "#\n# To try it without the devices:\n"
        "#   handcast up {} --set camera.backend=twin --set projector.backend=twin\n",
        one_line(file.filename().string()));
  return text + fmt::format("\nname = {}\n", toml_string(plan.name));
}

std::string calibration(const Plan& plan, const std::filesystem::path& file) {
  if (plan.calibration)
    return fmt::format(
        "\n# Size and lens of the camera, and the homography from it to the projector.\n"
        "calibration = {}\n",
        toml_string(named_in(file, plan.calibration_file)));
  if (!plan.needs_calibration()) return {};
  return fmt::format(
      "\n# THIS IS MISSING. Without a calibration of camera and projector the light misses the "
      "hand. This makes it, and names it in a file beside this one:\n"
      "#   {}\n"
      "# calibration = {}\n",
      calibrate_command(plan, file.filename()),
      toml_string(file.stem().string() + "_calibration.toml"));
}

/// The line that names a device.
std::string device_line(const Candidate& candidate, std::string_view setting) {
  return fmt::format("{} = {}\n", setting, toml_string(candidate.name));
}

/// The rate with two digits after the point. A rate above the highest one is refused.
double rounded_down(double rate_hz) {
  constexpr double kOfBinary = 1e-6;  // 29.97 is a little less
  return std::floor(100 * rate_hz + kOfBinary) / 100;
}

std::string rate_of_camera(const Images& images) {
  if (images.rate_hz <= 0)
    return fmt::format(
        "# The camera does not say what it holds in {}; a higher rate makes the light follow "
        "better.\nrate_hz = {:g}\n",
        text_of(images.size), kUnknownRate_hz);
  return fmt::format("# The highest rate that it has in {}.\nrate_hz = {}\n", text_of(images.size),
                     std::clamp(rounded_down(images.rate_hz), 1., 2000.));
}

std::string exposure_of(const Images& images) {
  const double rate_hz = images.rate_hz > 0 ? images.rate_hz : kUnknownRate_hz;
  return fmt::format(
      "# Short: a moving hand is blurred. More infrared light is better than a longer exposure.\n"
      "exposure_ms = {:.3g}\n",
      std::clamp(1000 * kMostOfThePeriod / rate_hz, 0.01, kExposure_ms));
}

std::string camera(const Plan& plan) {
  const auto& chosen = plan.camera;
  if (!chosen.is_device())
    return "\n[camera]\n"
           "# The digital twin. `handcast devices` lists real cameras with the lines to write "
           "here.\n"
           "backend = \"twin\"\n";
  const auto images = images_of(plan);
  auto text = fmt::format("\n[camera]\n# {}\nbackend = {}\n", one_line(chosen.device.name),
                          toml_string(chosen.backend));
  text += device_line(chosen, chosen.backend + ".device");
  if (!images->format.empty())
    text += fmt::format("# What it sends: {}.\n{}.format = {}\n", one_line(chosen.device.about),
                        chosen.backend, toml_string(images->format));
  text += rate_of_camera(*images) + exposure_of(*images);
  if (chosen.backend == "v4l2")
    return text +
           "# From the end of an exposure to its image in memory, if the driver does not stamp the "
           "beginning.\n"
           "delivery_ms = 12\n";
  return text +
         "# From the end of an exposure to its image in memory: readout and transfer, about 3 ms "
         "for 720x540 by GigE.\n"
         "# A wrong value shifts the light on moving hands.\n"
         "delivery_ms = 0\n";
}

std::string real_tracker(const Plan& plan) {
  const auto head = fmt::format("\n[pose]\n# {}\n", one_line(plan.tracker_name));
  const auto landmarks =
      "\n[landmarks]\n"
      "backend = \"handcast\"\n";
  if (plan.tracker == Tracker::leapc) return head + "backend = \"leapc\"\n" + landmarks;
  return head +
         "backend = \"openxr\"\n"
         "# How long ago the newest joints were measured that the runtime has. It does not say; "
         "the step `tracker` of\n"
         "# `handcast calibrate` finds what is left of this.\n"
         "openxr.age_ms = 10\n" +
         landmarks;
}

std::string tracker(const Plan& plan) {
  if (plan.tracker == Tracker::leapc || plan.tracker == Tracker::openxr) return real_tracker(plan);
  if (plan.tracker == Tracker::twin)
    return "\n[pose]\n# The twin's tracker. With \"none\", the hand is found in the camera's image "
           "alone.\nbackend = \"twin\"\n";
  return fmt::format(
      "\n[pose]\n"
      "# No hand tracker: the landmarks in the camera's image are lifted to poses. The hand must "
      "be the brightest thing in it,\n"
      "# so the camera must see infrared light, and not the projector's "
      "(docs/operating/trackers.md, \"Without a hand tracker\").\n"
      "backend = \"none\"\n"
      "# How far the hand is from the camera. What counts is that it is at the calibration's "
      "distance.\n"
      "none.distance_m = {:g}\n"
      "# The person's hand from the wrist to the tip of the middle finger. 0: an average hand, "
      "whose size is learned.\n"
      "none.hand_length_mm = 0\n"
      "\n[landmarks]\n"
      "backend = \"handcast\"\n"
      "# One hand is found sooner, and never taken for two.\n"
      "hands = 1\n"
      "\n[cascade.predict]\n"
      "# How far the light may be predicted: images are older without a tracker.\n"
      "limit_ms = 80\n",
      plan.distance_m);
}

std::string display(const Plan& plan) {
  const auto& light = plan.light;
  const auto showing = showing_of(plan);
  auto text = fmt::format("\n[projector]\n# {}\nbackend = {}\n", one_line(light.device.name),
                          toml_string(light.backend));
  text += light.backend == "kms" ? device_line(light, "kms.connector")
                                 : device_line(light, "window.monitor");
  if (showing.is_scaled)
    text += fmt::format(
        "# {} is not the size of the projector in the calibration: the picture is scaled, which "
        "blurs it.\n",
        text_of(showing.size));
  if (!showing.mode.empty())
    text += fmt::format("# The mode that it prefers.\nkms.mode = {}\n", toml_string(showing.mode));
  return text + fmt::format(
                    "rate_hz = {:.4g}\n"
                    "# From handing over a frame to its light, by the projector itself: from its "
                    "manual, or a test. With a game mode\n"
                    "# about 16 ms.\n"
                    "latency_ms = 16\n"
                    "# Factor of the light, a limit for people's eyes.\n"
                    "brightness = 1\n",
                    showing.rate_hz);
}

std::string light(const Plan& plan) {
  if (plan.light.is_device()) return display(plan);
  if (plan.light.backend == "file")
    return "\n[projector]\n"
           "# The light goes to the folder light/, as pictures or as one film. `handcast devices` "
           "lists real displays.\n"
           "backend = \"file\"\n"
           "file.film = false\n"
           "rate_hz = 60\n";
  return fmt::format(
      "\n[projector]\n"
      "# The light goes to the digital twin. `handcast devices` lists real displays with the lines "
      "to write here.\n"
      "backend = \"twin\"\n{}",
      plan.camera.is_device() ? "rate_hz = 60\n" : "");
}

std::string controller(const Plan& plan) {
  if (!plan.controller) return {};
  return fmt::format(
      "\n[dlp]\n"
      "# {}\n"
      "backend = {}\n"
      "device = {}\n"
      "mode = \"video\"\n"
      "# The largest current that a LED ever gets, and the currents, as shares of the full scale. "
      "These are low; read the\n"
      "# data sheet of the LEDs before you raise them. On a board of another maker than TI, set "
      "the currents to 0 first: if\n"
      "# there is light then, signal is wrong for the board (docs/operating/light.md, \"A DLP "
      "projector with a controller\").\n"
      "limit = 0.1\n"
      "red = 0.05\n"
      "green = 0.05\n"
      "blue = 0.05\n",
      one_line(plan.controller->device.name), toml_string(plan.controller->backend),
      toml_string(plan.controller->name));
}

std::string observer(const Plan& plan) {
  if (!plan.camera.is_device()) return {};
  return "\n[observer]\n"
         "# It scores the light on the twin's hand; where a real hand is, nobody knows.\n"
         "enabled = false\n";
}

}  // namespace

std::string shell_word(const std::string& file) {
  constexpr std::string_view kChanged = " \t\n!\"#$&'()*;<=>?[\\]^`{|}~";
  if (file.find_first_of(kChanged) == file.npos) return file;
  std::string word = "'";
  for (const char c : file) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + '\'';
}

std::string calibrate_command(const Plan& plan, const std::filesystem::path& file) {
  constexpr Size kUnknown{1024, 768};
  const auto size = showing_of(plan).size;
  return fmt::format("handcast calibrate {} --camera {} --projector {} --apply",
                     shell_word(file.string()), text_of(images_of(plan)->size),
                     text_of(size.width_px > 0 ? size : kUnknown));
}

Showing showing_of(const Plan& plan) {
  const auto& modes = plan.light.device.modes;
  Showing showing;
  if (modes.empty()) return showing;
  const auto& first = modes.front();
  showing.size = {first.width_px, first.height_px};
  showing.rate_hz = first.rate_hz > 0 ? first.rate_hz : showing.rate_hz;
  if (!plan.needs_calibration()) {
    const auto calibration = plan.calibration.value_or(calib::Calibration());
    const Size wanted{calibration.projector.width_px, calibration.projector.height_px};
    const bool can_change = plan.light.backend == "kms";
    const auto fit = can_change ? fastest(modes, wanted) : std::nullopt;
    if (fit) return {.rate_hz = fit->rate_hz, .mode = {}, .is_scaled = false, .size = wanted};
    showing.is_scaled = showing.size != wanted;
  }
  if (plan.light.backend == "kms")
    showing.mode = fmt::format("{}@{:.4g}", text_of(showing.size), showing.rate_hz);
  return showing;
}

std::string rig_text(const Plan& plan, const std::filesystem::path& file) {
  return head(plan, file) + calibration(plan, file) + camera(plan) + tracker(plan) + light(plan) +
         controller(plan) + observer(plan);
}

}  // namespace handcast::init
