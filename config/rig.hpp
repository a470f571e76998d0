// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/sections/bridge.hpp"
#include "config/sections/cascade.hpp"
#include "config/sections/content.hpp"
#include "config/sections/desk.hpp"
#include "config/sections/dlp.hpp"
#include "config/sections/light.hpp"
#include "config/sections/projector.hpp"
#include "config/sections/sensors.hpp"
#include "config/sections/supervisor.hpp"
#include "config/sections/twin.hpp"
#include "config/sections/viewpoint.hpp"
#include "config/sections/watch.hpp"
#include "config/settings/frozen_file.hpp"
#include "ipc/base/result.hpp"

namespace handcast::config {

/// The contents of a rig file. Each section is a plain struct, whose settings are declared by its
/// describe() and listed in REFERENCE.md.
struct Rig {
  std::string name = "rig";  ///< used in messages, reports and the path of the control socket
  std::string calibration;   ///< path of the calibration file; empty: the reference rig
  /// The sections.
  /// @{
  Camera camera;
  Camera camera2{.backend = "none"};
  Pose pose;
  Landmarks landmarks;
  Landmarks landmarks2;
  Projector projector;
  SecondProjector projector2;
  Dlp dlp;
  Content content;
  Light light;
  Desk desk;
  Hand hand;
  Cascade cascade;
  Twin twin;
  Observer observer;
  Watch watch;
  Bridge bridge;
  Supervisor supervisor;
  /// @}
};

/// Declares the settings of a rig file: see field.hpp.
template <class Visitor>
void describe(Visitor& visitor, Rig& rig) {
  visitor.field("name", rig.name,
                "Name of the rig in messages, reports and the path of its control socket.");
  visitor.field(
      "calibration", rig.calibration,
      "Calibration file, relative to the rig file. Empty: the rig of the paper, whose file is "
      "config/calibrations/paper.toml.");
  visitor.section("camera", rig.camera, "The infrared camera.");
  visitor.section(
      "camera2", rig.camera2,
      "A second infrared camera, for pose.backend = \"stereo\"; backend = \"none\": there "
      "is none.");
  visitor.section("pose", rig.pose, "The hand tracker.");
  visitor.section("landmarks", rig.landmarks, "The landmark detector.");
  visitor.section("landmarks2", rig.landmarks2, "The landmark detector of the second camera.");
  visitor.section("projector", rig.projector, "The projector.");
  visitor.section("projector2", rig.projector2,
                  "A second projector, which lights the same hands from another side; backend = "
                  "\"none\": there is none.");
  visitor.section("dlp", rig.dlp, "The projector's own controller.");
  visitor.section("content", rig.content, "What is on the hands.");
  visitor.section("light", rig.light, "The light as a whole, as a person beside it turns it.",
                  Effect::live);
  visitor.section("desk", rig.desk, "What people work the rig with: a page, OSC, MIDI, cues.");
  visitor.section("hand", rig.hand, "The model of the hand that is drawn.");
  visitor.section("cascade", rig.cascade, "The steps from sensor data to light.");
  visitor.section("twin", rig.twin,
                  "The digital twin, for the simulator and all back ends named twin.");
  visitor.section("observer", rig.observer, "The service that scores the light.");
  visitor.section("watch", rig.watch, "The night watch: the service that looks after the rig.");
  visitor.section("bridge", rig.bridge, "The service that joins rigs on several computers.");
  visitor.section("supervisor", rig.supervisor, "Start, supervision and stop of the services.");
}

/// The name at a viewpoint of what is called `name` ("camera.frames", "landmarks") at the first
/// one: "camera2.frames", "landmarks2". Names of what all viewpoints share ("pose.hands") stay.
std::string name_at(Viewpoint at, std::string_view name);
/// The same of what is the projector's: "projector.kms" and "projection.frames" become
/// "projector2.kms" and "projection2.frames".
std::string name_at_projector(Viewpoint at, std::string_view name);
/// The reverse of both: what is called "camera2.v4l2" at the second viewpoint is "camera.v4l2". ""
/// for names that are not of the second one.
std::string name_at_first(std::string_view name);
/// The section of the camera at a viewpoint.
const Camera& camera_at(const Rig& rig, Viewpoint at);
/// The section of the landmark detector at a viewpoint.
const Landmarks& landmarks_at(const Rig& rig, Viewpoint at);

/// The rig as the projector at a viewpoint has it: `projector` is its own section.
Rig rig_at_projector(Rig rig, Viewpoint at);

/// The section [NAME.process] of the service with this name ("camera"); of a guest, that of the
/// service that it feeds (guests.hpp); the defaults if there is no such service.
Process process_of(const Rig& rig, std::string_view service);
/// Whether a rig file has a section [NAME.process] for this service.
bool has_process(std::string_view service);

/// Reads a rig file, applies the measured settings beside it (measured.hpp), the live ones that
/// were saved (live_files.hpp), and `settings` ("path=value") on top. Relative paths become
/// absolute: those of the files start at their folder, those of `settings` at the current folder.
/// Errors: bad_config, with one line for each fault, e.g. "FILE:LINE: camera.rate_hz: 0 is
/// outside 1..2000 Hz".
Result<Rig> load_rig(const std::filesystem::path& file,
                     const std::vector<std::string>& settings = {});

/// Like load_rig(), from memory and without measured settings. `file` is used in messages, and
/// relative paths start at its folder.
Result<Rig> parse_rig(const std::string& toml, const std::filesystem::path& file,
                      const std::vector<std::string>& settings = {});

/// The rig after another text, which is applied like a rig file, and `settings` on top. Errors:
/// those of load_rig().
Result<Rig> change_rig(const Rig& rig, const NamedText& layer,
                       const std::vector<std::string>& settings);

/// The rig as a commented TOML file with all settings, which load_rig() reads back.
std::string print_rig(const Rig& rig);

/// True if the value of this setting ("twin.motion") may be a path.
bool names_a_file(std::string_view setting);
/// True if this value of the setting is a path, which load_rig() makes absolute, and not "", a word
/// ("builtin:wave", "webxr") or a frozen file.
bool is_path(std::string_view setting, std::string_view value);

/// The text of config/REFERENCE.md, generated from the declarations of the settings.
std::string print_reference();

}  // namespace handcast::config
