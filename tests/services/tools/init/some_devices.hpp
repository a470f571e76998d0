// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/tools/devices/attached.hpp"

namespace handcast::init {

// Devices as `handcast devices` lists them.

inline devices::Mode mode(int width_px, int height_px, double rate_hz,
                          const std::string& format = "") {
  return {format, width_px, height_px, width_px, height_px, rate_hz};
}

inline devices::Attached webcam(const std::string& card, const std::string& path,
                                std::vector<devices::Mode> modes) {
  return {.kind = devices::Kind::camera,
          .name = "'" + card + "' (" + path + ", usb-" + path.back() + ")",
          .about = "some formats",
          .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", path}},
          .names = {card, "usb-" + path.substr(path.size() - 1), path},
          .modes = std::move(modes)};
}
inline devices::Attached colour_webcam() {
  return webcam(
      "HD Webcam", "/dev/video0",
      {mode(640, 480, 30, "YUYV"), mode(1280, 720, 10, "YUYV"), mode(1280, 720, 30, "MJPEG")});
}
inline devices::Attached infrared_webcam() {
  return webcam("IR Webcam", "/dev/video2", {mode(640, 360, 15, "GREY")});
}
inline devices::Attached industrial_camera() {
  return {.kind = devices::Kind::camera,
          .name = "Basler acA720-520um, serial number 23456789",
          .about = "USB3Vision at 1",
          .settings = {{"camera.backend", "aravis"}, {"camera.aravis.device", "23456789"}},
          .names = {"23456789", "Basler-23456789", "acA720-520um"},
          .modes = {{"", 32, 32, 720, 540, 525}}};
}
inline devices::Attached monitor(const std::string& output, const std::string& model,
                                 bool is_primary) {
  return {.kind = devices::Kind::display,
          .name = "'" + output + "' (" + model + ")",
          .about = "",
          .settings = {{"projector.backend", "window"}, {"projector.window.monitor", output}},
          .names = {model, output},
          .modes = {mode(1280, 800, 60)},
          .is_operators = is_primary};
}
inline devices::Attached connector(const std::string& output, const std::string& model) {
  return {.kind = devices::Kind::display,
          .name = "'" + output + "' (" + model + ") of /dev/dri/card0",
          .about = "without a window system",
          .settings = {{"projector.backend", "kms"}, {"projector.kms.connector", output}},
          .names = {model, output},
          .modes = {mode(1280, 800, 59.81), mode(1024, 768, 60), mode(1024, 768, 120)},
          .is_operators = output.starts_with("eDP")};
}
inline devices::Attached controller() {
  return {.kind = devices::Kind::controller,
          .name = "DLPC350 (LightCrafter 4500), serial number LCR3, /dev/hidraw0",
          .about = "",
          .settings = {{"dlp.backend", "lightcrafter"}, {"dlp.device", "LCR3"}},
          .names = {"LCR3", "/dev/hidraw0"}};
}

inline devices::Attached tracker(const std::string& backend, const std::string& name,
                                 const std::string& trouble = "") {
  return {.kind = devices::Kind::tracker,
          .name = name,
          .about = "",
          .settings = {{"pose.backend", backend}},
          .trouble = trouble,
          .names = {backend}};
}

}  // namespace handcast::init
