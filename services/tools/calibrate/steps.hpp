// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "services/tools/calibrate/desk.hpp"
#include "services/tools/calibrate/rig_settings.hpp"

namespace handcast::calibrate {

/// A step, or a part of --check: whose scene it needs, what it does, what a person does for it.
struct StepEntry {
  Step step;
  Result<Outcome> (*measure)(Desk& desk);
  const char* instruction;
};

const StepEntry& entry_of(Step step);
/// The steps to do now: those that were asked for, else those that are left.
std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session);

/// Says what to do, and waits until a person is ready. False if the step shall be left out. Error
/// unavailable: the program was asked to stop.
Result<bool> is_wanted(const Options& options, Keys& keys, const StepEntry& entry);

/// Starts the rig as a step needs it, or, if `is_up`, uses the one that runs; and measures, which
/// writes to the draft. `logs`: a folder for what the rig prints. Prints the outcome.
Result<Outcome> with_rig(const Options& options, const RunningAs& running,
                         const std::filesystem::path& logs, calib::Calibration& draft, Keys& keys,
                         const StepEntry& entry, bool is_up = false);

}  // namespace handcast::calibrate
