// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "services/tools/init/candidate.hpp"
#include "services/tools/init/options.hpp"
#include "services/tools/init/prompt.hpp"

namespace handcast::init {

/// The back ends of `pose` that a new rig can have.
enum class Tracker {
  none,    ///< landmarks are lifted to poses
  twin,    ///< watches the twin's hand
  leapc,   ///< Ultraleap's service
  openxr,  ///< an OpenXR runtime
};
constexpr std::array<std::string_view, 4> words_of(Tracker) {
  return {"none", "twin", "leapc", "openxr"};
}

/// What a rig file is written from.
struct Plan {
  std::string name;
  Candidate camera;
  Candidate light;
  Tracker tracker = Tracker::twin;
  std::string tracker_name{};  ///< of a real one, for people
  double distance_m = 0.73;    ///< from the camera to the hand, if there is no tracker
  /// Empty: none yet, or the reference rig's for the twin.
  /// @{
  std::filesystem::path calibration_file;
  std::optional<calib::Calibration> calibration;
  /// @}
  std::optional<Candidate> controller;  ///< of the projector

  bool needs_calibration() const { return camera.is_device() && !calibration; }
};

/// The images that the plan's camera should send; those of the reference rig's size if it does not
/// say what it can. nullopt: it has none of the calibrated size.
std::optional<Images> images_of(const Plan& plan);

/// Finds out what a rig is made of, by the flags, at most six questions, and best guesses.
/// `prompt`: null if there is nobody to ask. Errors: those of settle().
Result<Plan> interview(const std::vector<devices::Attached>& attached, const Options& options,
                       Prompt* prompt);

}  // namespace handcast::init
