// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "services/tools/calibrate/desk.hpp"
#include "services/tools/calibrate/rig_settings.hpp"

namespace handcast::calibrate {

/// One step of a calibration: what it needs, what a person does for it, what it finds out. Each is
/// in a file of its own, X_step.cpp.
struct StepEntry {
  Step step;
  /// Its sentence in the calibration file and the report; null: it measures no part of the file.
  std::string calib::Made::*made = nullptr;
  /// The settings (for --set) with which the twin shows what it needs. `camera_hz`: the rate of the
  /// camera.
  std::vector<std::string> (*scene)(const Options& options, double camera_hz);
  /// What a person does for measure(), or for check() if options.check.
  const char* (*instruct)(const Options& options);
  /// Measures, and writes to the draft.
  Result<Outcome> (*measure)(Desk& desk);
  /// Compares the calibration in use with what it finds, and changes nothing; is_good: nothing has
  /// moved. Null: there is nothing to compare.
  Result<Outcome> (*check)(Desk& desk) = nullptr;
};

/// The steps.
/// @{
extern const StepEntry kLensStep, kSecondLensStep, kPairStep, kScreenStep, kTrackerStep, kLightStep;
/// @}

const StepEntry& entry_of(Step step);
/// The steps to do now: those that were asked for, else those that are left.
std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session);

/// For StepEntry::scene: the twin holds the board at each place for so long.
std::vector<std::string> board_scene(const Options& options, double hold_s);

/// Does a step as far as its measurement, with a rig that it starts. Empty if a person has left it
/// out. `logs`: a folder for what the rig prints. Prints the outcome. Errors: those of measure()
/// and of the rig; unavailable (the program was asked to stop).
Result<std::optional<Outcome>> measure_step(const Options& options, const RunningAs& running,
                                            const std::filesystem::path& logs,
                                            calib::Calibration& draft, Keys& keys, Step step);

/// Error bad_config: the rig is up, and a step needs it down.
Result<void> check_down(const config::Rig& rig);

/// --check: compares an installed rig with its calibration, and changes nothing. Beside a rig that
/// is up, else with one that it starts. Returns kExitBadResult if something has moved. Errors:
/// bad_config (--set with a rig that is up, or it runs with another calibration), those of the
/// checks and of the rig.
Result<int> check_installed(const Options& options, const config::Rig& rig,
                            const RunningAs& running);

}  // namespace handcast::calibrate
