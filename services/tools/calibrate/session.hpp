// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/findings.hpp"

namespace handcast::calibrate {

/// One calibration of a rig, which may take several calls of the program: the folder with what was
/// measured so far (draft.toml, and STEP.json and report.json for the report), and the calibration
/// file that it becomes. One thread.
class Session {
 public:
  /// Opens the session in options.folder, or begins one. `used`: the calibration that the rig's
  /// services have meanwhile, and the devices that are calibrated. Errors: bad_config (the folder
  /// cannot be made, or a draft of other images or devices), those of calib::load_calibration() for
  /// a draft.
  static Result<Session> open(const Options& options, const config::Rig& rig,
                              const calib::Calibration& used);

  /// The calibration as far as it was measured; the rest is that of the rig.
  const calib::Calibration& draft() const { return draft_; }
  /// The file that the calibration becomes: the rig's own, or a new one next to the rig file.
  const std::filesystem::path& target() const { return target_; }
  /// The folder of the session.
  const std::filesystem::path& folder() const { return folder_; }
  /// A file of the session.
  std::filesystem::path file(std::string_view name) const { return folder_ / name; }

  /// True if this step was done.
  bool is_done(Step step) const;
  /// True if a part of the calibration was measured.
  bool has_measured() const;
  /// True if the draft has what is not in target(): since keep() of a part of the calibration, or
  /// because there is no such file, until finish().
  bool is_pending() const;
  /// The settings that the steps have measured; of one that two have measured, the newest.
  std::vector<config::MeasuredSetting> settings() const;
  /// To be called when they are in the rig's file of measured settings.
  void forget_settings() const;
  /// Makes what a step has measured the draft, and keeps the step's outcome and settings for the
  /// report and for later. What was measured with an older lens is forgotten. Errors: bad_data (the
  /// outcome is not good, and all stays as it is), unavailable (a file cannot be written).
  Result<void> keep(Step step, const Outcome& outcome, const calib::Calibration& measured);
  /// Writes the draft to target(), and as opencv.yml to the session's folder for other programs;
  /// the file before it is kept with a number above `above` (write_and_keep()). Returns a sentence
  /// about where they are. Errors: unavailable, bad_config.
  Result<std::string> finish(int above = 0) const;

 private:
  Session(std::filesystem::path folder, std::filesystem::path target, calib::Calibration draft)
      : folder_(std::move(folder)), target_(std::move(target)), draft_(std::move(draft)) {}
  void forget(Step step);
  Result<void> keep_settings(Step step, const std::vector<config::MeasuredSetting>& settings) const;
  Result<void> write_report() const;
  std::filesystem::path outcome_of(Step step) const;
  std::filesystem::path settings_of(Step step) const;

  std::filesystem::path folder_, target_;
  std::vector<Step> steps_;  ///< that the rig has need of
  std::string rig_name_;
  NamedFiles command_;  ///< that goes on with this session
  calib::Calibration draft_;
};

}  // namespace handcast::calibrate
