// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/tools/devices/attached.hpp"

namespace handcast::init {

/// What can be the camera, the light or the controller of a rig: a device, or a back end that
/// needs none.
struct Candidate {
  std::string word;            ///< how an answer calls it: "v4l2:HD Webcam", "twin"
  std::string text;            ///< for people
  std::string backend;         ///< in the rig file: "v4l2", "twin"
  std::string name{};          ///< of the device in the rig file; empty: a back end without one
  devices::Attached device{};  ///< with a name

  bool is_device() const { return !name.empty(); }
};

/// The cameras among the devices, then the twin's.
std::vector<Candidate> cameras_among(const std::vector<devices::Attached>& attached);
/// The displays among the devices, then files and the twin.
std::vector<Candidate> lights_among(const std::vector<devices::Attached>& attached);
/// The controllers of projectors among the devices.
std::vector<Candidate> controllers_among(const std::vector<devices::Attached>& attached);

/// The index of the camera that is probably meant: one that can be opened, an industrial or
/// infrared one before others; the twin's if there is none.
std::size_t likely_camera(std::span<const Candidate> cameras);
/// The same for the light: a display that can be opened and is not the operator's.
std::size_t likely_light(std::span<const Candidate> lights);

/// The index of the candidate that an answer means: its word, a name of its device, its back end,
/// or three letters or more of its text. Errors: unavailable (none), bad_config (several), with
/// those that can be meant.
Result<std::size_t> find(std::span<const Candidate> candidates, std::string_view answer);

/// A device that is not attached yet, by an answer "BACKEND:NAME" with one of the back ends;
/// nullopt if it is none. What it can do is not known.
std::optional<Candidate> not_attached(std::string_view answer,
                                      std::span<const std::string_view> backends);

/// A text of a device as one line of ASCII, because a device may call itself anything; other
/// bytes become '?'.
std::string one_line(std::string_view text);

/// A size in pixels.
struct Size {
  int width_px = 0, height_px = 0;
  bool operator==(const Size&) const = default;
};

/// Images of one size.
struct Images {
  std::string format;  ///< as in a rig file; empty: nothing to choose
  Size size;
  double rate_hz = 0;  ///< 0: the device does not say
};

/// The fastest images of this size. nullopt: there are none.
std::optional<Images> fastest(const std::vector<devices::Mode>& modes, Size size);

/// What a camera that is not calibrated yet should send: the fastest images of at least 640x480, of
/// equally fast ones those nearest to the size of the reference rig; the largest ones if all are
/// smaller. `modes`: at least one.
Images recommended(const std::vector<devices::Mode>& modes);

}  // namespace handcast::init
