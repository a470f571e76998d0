// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/desk/base/panel.hpp"

/// What pages are told that stays as it is while the desk is up.
namespace handcast::desk {

/// What is calibrated, as JSON: {"file", "age_days", "steps": [{"step", "what", "made",
/// "command"}]}. `age_days`: null if there is no file; `made`: how and when, "" if that is not
/// known.
std::string calibration_facts(const config::Rig& rig, const std::filesystem::path& rig_file,
                              const calib::Calibration& calibration);

/// What starts the cues of a list, and what they do, in words, as JSON: [{"on", "does"}]. `[]` if
/// the file is none.
std::string cue_facts(const std::filesystem::path& file, std::span<const Control> controls);

/// The looks, sorted, as `handcast content` lists them: [{"name", "picture"}]. `picture`: there is
/// one of it.
nlohmann::json looks();
/// The picture of a look, PNG; empty: there is none, or no such look.
std::optional<std::string> picture_of_look(std::string_view look);

/// The back ends of the services, by name: [{"name", "sentence"}].
nlohmann::json backends();
/// A control as a page gets it.
nlohmann::json json_of(const Control& control);

}  // namespace handcast::desk
