// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"
#include "services/tools/devices/attached.hpp"

namespace handcast::calibrate {

/// The devices that a calibration was made with, by names that calib::check_device() accepts for
/// them. Empty: it has no name (the twin), or the rig file does not say which of several it is.
struct OwnDevices {
  std::string camera, projector;
  /// All names of each; empty if it is not attached.
  /// @{
  std::vector<std::string> camera_names{}, projector_names{};
  /// @}
  /// The same of a second camera.
  /// @{
  std::string camera2{};
  std::vector<std::string> camera2_names{};
  /// @}
};

/// The devices of a rig. `attached`: those of this computer, in which an unnamed one is looked up.
OwnDevices own_devices(const config::Rig& rig, const std::vector<devices::Attached>& attached);
/// The same with what is attached now. Takes a second if the rig has devices.
OwnDevices own_devices(const config::Rig& rig);

/// False for a step that measures what the rig does not have. Poses from two cameras are in the
/// space of the first one: there is no tracker whose place could be wrong.
bool has_need_of(const config::Rig& rig, Step step);

/// Errors: bad_config (a step, --correct, --reflector or --camera2 needs a second camera or a
/// tracker that the rig does not have; something is to be compared with the calibration, and the
/// rig names none).
Result<void> check_steps(const Options& options, const config::Rig& rig);

/// How the rig runs while it is being calibrated.
struct RunningAs {
  calib::Calibration calibration;     ///< that its services use meanwhile
  std::vector<std::string> settings;  ///< for --set
  /// If the rig's calibration is that of other devices: a part of the names of files for the
  /// devices that the rig has now. Else empty.
  std::string new_devices{};
  bool is_second_guessed = false;  ///< the place of the second camera is not known
};

/// A projector of which only the sizes are known: its image is as large as the camera's.
calib::ProjectorModel rough_projector(Size camera, Size projector);

/// The rig with its own calibration. If it names none and has real devices, or if its calibration
/// is that of other devices than `own`, with one that has only the sizes of the images
/// (options.camera, options.projector) and is written to the session's folder. If only the second
/// camera of two is not calibrated, with a guess of that one. Errors: bad_config (the sizes are
/// missing; --check, --correct or --points, and the calibration is that of other devices), those of
/// calib::load_calibration().
Result<RunningAs> rig_as_it_runs(const Options& options, const config::Rig& rig,
                                 const OwnDevices& own = {});

/// Errors: bad_config (--check, --correct or --points, and the second camera is a guess; a
/// size of --camera, --camera2 or --projector is not that of the calibration in use, and has no
/// effect).
Result<void> check_known(const Options& options, const RunningAs& running);

}  // namespace handcast::calibrate
