// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/renamed_settings.hpp"
#include "config/sections/cascade.hpp"
#include "config/sections/projector.hpp"
#include "config/sections/sensors.hpp"
#include "config/sections/supervisor.hpp"
#include "config/sections/twin.hpp"
#include "ipc/base/result.hpp"

namespace handcast::config {

/// Everything one rig is made of: the whole of a rig file. Sections are plain structs; `describe`
/// declares their settings.
struct Rig {
  std::string name = "rig";
  std::string calibration;  ///< path of the calibration file; empty: the reference rig's
  Camera camera;
  Pose pose;
  Landmarks landmarks;
  Projector projector;
  Content content;
  Hand hand;
  Cascade cascade;
  Twin twin;
  Observer observer;
  Supervisor supervisor;
};

template <class Visitor>
void describe(Visitor& visitor, Rig& rig) {
  visitor.field("name", rig.name, "Names the rig in messages, the report and its control socket.");
  visitor.field(
      "calibration", rig.calibration,
      "Calibration file, relative to the rig file. Empty: the reference rig of the paper.");
  visitor.section("camera", rig.camera, "The infrared camera.");
  visitor.section("pose", rig.pose, "The hand tracker.");
  visitor.section("landmarks", rig.landmarks, "The landmark detector.");
  visitor.section("projector", rig.projector, "The projector.");
  visitor.section("content", rig.content, "What is painted.");
  visitor.section("hand", rig.hand, "The hand that is drawn.");
  visitor.section("cascade", rig.cascade, "From sensors to light.");
  visitor.section("twin", rig.twin,
                  "The digital twin, for every back end named twin and for the simulator.");
  visitor.section("observer", rig.observer, "The judge.");
  visitor.section("supervisor", rig.supervisor, "Starting, watching, stopping.");
}

/// How the service of this name ("camera") runs: its [NAME.process]. One that no rig file knows:
/// the defaults.
Process process_of(const Rig& rig, std::string_view service);

/// Reads a rig file and applies `settings` ("path=value") on top. Paths become absolute: those of
/// the file from its folder, those of `settings` from the current one. Every fault of the file is
/// in the one error (bad_config), a line each: "FILE:LINE: camera.rate_hz: 0 is outside 1..2000
/// Hz". Settings in an old form (renamed_settings) are read as their new one; each is told to
/// `on_renamed`.
Result<Rig> load_rig(const std::filesystem::path& file,
                     const std::vector<std::string>& settings = {},
                     const OnRenamed& on_renamed = log_renamed);

/// The same from memory; `file` names it in messages and is what relative paths are relative to.
Result<Rig> parse_rig(const std::string& toml, const std::filesystem::path& file,
                      const std::vector<std::string>& settings = {},
                      const OnRenamed& on_renamed = log_renamed);

/// The whole rig as commented TOML: what load_rig reads back to the same rig.
std::string print_rig(const Rig& rig);

/// The setting names a file or folder ("twin.motion"): what load_rig makes absolute.
bool names_a_file(std::string_view setting);

/// The settings reference (config/REFERENCE.md), from the declarations alone.
std::string print_reference();

}  // namespace handcast::config
