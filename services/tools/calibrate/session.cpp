// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "calib/opencv_file.hpp"
#include "calib/solve/board/board_name.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/kept_file.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraft = "draft.toml";
constexpr const char* kPending = "pending";

constexpr std::array kSteps{Step::lens,   Step::lens2,   Step::pair,
                            Step::screen, Step::tracker, Step::light};

/// The sentence of a step in the calibration; empty if it was not measured, or is no part of it.
std::string sentence_of(const calib::Made& made, Step step) {
  const auto member = entry_of(step).made;
  return member ? made.*member : std::string();
}

/// The rig's own file; a new one next to the rig file if it has none.
fs::path target_of(const Options& options, const config::Rig& rig) {
  if (!rig.calibration.empty()) return rig.calibration;
  return fs::absolute(options.rig_file).replace_extension("").string() +
         (options.second_projector ? "_projector2" : "") + "_calibration.toml";
}

/// Gives a device of a draft the name of the one in use. Error bad_config: it has another name.
Result<void> adopt(const char* what, const std::string& now, std::string& before) {
  if (!before.empty() && !now.empty() && before != now)
    return fail(Errc::bad_config,
                fmt::format("it was the {} '{}', and now it is '{}'", what, before, now));
  if (before.empty()) before = now;
  return {};
}

Result<void> check_images(const char* what, const calib::CameraModel& now,
                          const calib::CameraModel& before) {
  if (now.width_px == before.width_px && now.height_px == before.height_px) return {};
  return fail(Errc::bad_config,
              fmt::format("images of the {} had {}x{} px, and now have {}x{}", what,
                          before.width_px, before.height_px, now.width_px, now.height_px));
}

/// Makes a draft one of the devices in use. Error bad_config: it is of others.
Result<void> adopt_devices(const calib::Calibration& used, calib::Calibration& draft) {
  auto same = check_images("camera", used.camera, draft.camera);
  if (same) same = adopt("camera", used.camera_device, draft.camera_device);
  if (same && used.camera2) {
    if (!draft.camera2) draft.camera2 = used.camera2;
    same = check_images("second camera", used.camera2->camera, draft.camera2->camera);
    if (same) same = adopt("second camera", used.camera2->device, draft.camera2->device);
  }
  return same ? adopt("projector", used.projector_device, draft.projector_device) : same;
}

NamedFiles named_by(const Options& options) {
  NamedFiles command{options.rig_file.string(), calib::print_board_name(options.board), {}};
  if (options.second_projector) command.option = "--second-projector";
  if (command.board == calib::print_board_name(calib::Board{})) command.board.clear();
  if (options.folder != default_folder(options)) command.folder = options.folder.string();
  return command;
}

/// What a new measurement makes worthless: it was measured with the old lens.
std::vector<Step> outdated_by(Step step) {
  if (step == Step::lens) return {Step::pair, Step::screen, Step::tracker};
  if (step == Step::lens2) return {Step::pair};
  return {};
}

/// The draft without a second camera whose place nobody has measured: it is a guess with which the
/// cameras could be started.
calib::Calibration without_guess(calib::Calibration draft, const fs::path& target) {
  std::error_code unknown;
  if (!draft.camera2 || !draft.made.pair.empty()) return draft;
  const auto before =
      fs::exists(target, unknown) ? calib::load_calibration(target) : Result<calib::Calibration>{};
  if (before && !before->camera2) draft.camera2.reset();
  return draft;
}

/// The settings that a step has measured. A file with none is ignored with a sentence.
std::vector<config::MeasuredSetting> read_settings(const fs::path& file) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return {};
  auto settings = config::read_measured(file);
  if (settings && !settings->empty()) return std::move(*settings);
  fmt::print(stderr, "  {} holds no measured settings, and is ignored: measure that step again\n",
             printable(file.string()));
  return {};
}

Result<void> write_settings(const fs::path& file,
                            const std::vector<config::MeasuredSetting>& settings) {
  if (!settings.empty()) return write_whole(file, config::print_measured(settings));
  std::error_code absent;
  fs::remove(file, absent);
  return {};
}

}  // namespace

Result<Session> Session::open(const Options& options, const config::Rig& rig,
                              const calib::Calibration& used) {
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error)
    return fail(Errc::bad_config, fmt::format("the folder '{}' cannot be made: {}",
                                              options.folder.string(), error.message()));
  Session session(fs::absolute(options.folder), target_of(options, rig), used);
  session.rig_name_ = rig.name;
  session.command_ = named_by(options);
  session.draft_.made = {};
  std::ranges::copy_if(kSteps, std::back_inserter(session.steps_), [&](Step step) {
    return concerns(options, step) && has_need_of(rig, step);
  });
  const auto file = session.file(kDraft);
  const bool has_draft = fs::exists(file, error);
  if (error)
    return fail(Errc::bad_config, fmt::format("the folder '{}' cannot be read: {}",
                                              options.folder.string(), error.message()));
  if (options.restart || !has_draft) {
    for (const Step step : kSteps) session.forget(step);
    fs::remove(file, error);
    fs::remove(session.file(kPending), error);
    return session;
  }
  auto draft = calib::load_calibration(file);
  if (!draft)
    return fail(draft.error().code,
                fmt::format("{}; --restart forgets what was measured before", draft.error().what));
  if (auto same = adopt_devices(used, *draft); !same)
    return fail(same.error().code, fmt::format("what was measured before, in {}: {}; --restart "
                                               "forgets it",
                                               session.folder_.string(), same.error().what));
  session.draft_ = *draft;
  return session;
}

bool Session::is_done(Step step) const {
  std::error_code unknown;
  return entry_of(step).made ? !sentence_of(draft_.made, step).empty()
                             : fs::exists(outcome_of(step), unknown);
}

bool Session::has_measured() const {
  return std::ranges::any_of(kSteps,
                             [&](Step step) { return !sentence_of(draft_.made, step).empty(); });
}

bool Session::is_pending() const {
  std::error_code unknown;
  return has_measured() && (fs::exists(file(kPending), unknown) || !fs::exists(target_, unknown));
}

std::vector<config::MeasuredSetting> Session::settings() const {
  std::vector<config::MeasuredSetting> all;
  for (const Step step : kSteps) {
    const auto settings = read_settings(settings_of(step));
    all.insert(all.end(), settings.begin(), settings.end());
  }
  return all;
}

void Session::forget_settings() const {
  std::error_code absent;
  for (const Step step : kSteps) fs::remove(settings_of(step), absent);
}

fs::path Session::settings_of(Step step) const {
  return file(fmt::format("{}.settings", config::word_of(step)));
}

Result<void> Session::keep_settings(Step step,
                                    const std::vector<config::MeasuredSetting>& settings) const {
  for (const Step other : kSteps) {
    auto older = read_settings(settings_of(other));
    const auto outdated = std::erase_if(older, [&](const config::MeasuredSetting& old) {
      return std::ranges::count(settings, old.path, &config::MeasuredSetting::path) > 0;
    });
    if (other == step || outdated == 0) continue;
    if (auto written = write_settings(settings_of(other), older); !written) return written;
  }
  return write_settings(settings_of(step), settings);
}

fs::path Session::outcome_of(Step step) const {
  return file(fmt::format("{}.json", config::word_of(step)));
}

void Session::forget(Step step) {
  std::error_code absent;
  if (const auto made = entry_of(step).made) (draft_.made.*made).clear();
  fs::remove(outcome_of(step), absent);
  fs::remove(settings_of(step), absent);
}

Result<void> Session::keep(Step step, const Outcome& outcome, const calib::Calibration& measured) {
  if (!outcome.is_good)
    return fail(Errc::bad_data,
                "this is not good enough to be used, and was not kept; measure it again");
  draft_ = measured;
  for (const Step later : outdated_by(step)) forget(later);
  auto kept = keep_settings(step, outcome.settings);
  if (const auto made = entry_of(step).made) {
    draft_.made.*made = fmt::format("{}: {}", local_time("%Y-%m-%d"), outcome.made);
    if (kept) kept = write_whole(file(kPending), "the draft is not in its place yet\n");
  }
  // The measurement before its findings, for which a disk may have no room.
  if (kept) kept = write_whole(file(kDraft), calib::print_calibration(draft_));
  std::error_code absent;
  if (kept) fs::remove(outcome_of(step), absent);  // old figures must not stand under the new ones
  if (kept) kept = write_whole(outcome_of(step), print_outcome(outcome));
  return kept ? write_report() : kept;
}

Result<void> Session::write_report() const {
  std::vector<Reported> reported;
  for (const Step step : steps_)
    reported.push_back({step, sentence_of(draft_.made, step), is_done(step)});
  return write_whole(file("report.json"), print_report(rig_name_, command_, reported));
}

Result<std::string> Session::finish(int above) const {
  // A file that the services would refuse must not take the place of a good one.
  if (const auto usable = calib::load_calibration(file(kDraft)); !usable)
    return tl::make_unexpected(usable.error());
  const auto measured = without_guess(draft_, target_);
  auto sentence = write_and_keep(target_, calib::print_calibration(measured), above);
  if (!sentence) return sentence;
  std::error_code absent;
  fs::remove(file(kPending), absent);
  return write_whole(file("opencv.yml"), calib::print_opencv_file(measured)).map([&] {
    return "the calibration is in " + *sentence;
  });
}

}  // namespace handcast::calibrate
