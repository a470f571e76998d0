// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "calib/opencv_file.hpp"
#include "calib/solve/board/board_name.hpp"
#include "config/settings/choice.hpp"
#include "config/settings/files.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/kept_file.hpp"
#include "services/tools/calibrate/pieces.hpp"
#include "services/tools/calibrate/steps.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraft = "draft.toml";
constexpr const char* kPending = "pending";

constexpr std::array kSteps{Step::lens,   Step::lens2,   Step::pair,
                            Step::screen, Step::tracker, Step::light};

/// The sentence of a step in the calibration; null if the step measures no part of it.
std::string* made_of(calib::Made& made, Step step) {
  const auto member = entry_of(step).made;
  return member ? &(made.*member) : nullptr;
}

/// The rig's own file; a new one next to the rig file if it has none.
fs::path target_of(const Options& options, const config::Rig& rig) {
  if (!rig.calibration.empty()) return rig.calibration;
  return fs::absolute(options.rig_file).replace_extension("").string() + "_calibration.toml";
}

/// Gives a draft the names of the devices in use. Error bad_config: it has others.
Result<void> adopt_devices(const calib::Calibration& used, calib::Calibration& draft) {
  const auto adopt = [](const char* what, const std::string& now,
                        std::string& before) -> Result<void> {
    if (!before.empty() && !now.empty() && before != now)
      return fail(Errc::bad_config,
                  fmt::format("it was the {} '{}', and now it is '{}'", what, before, now));
    if (before.empty()) before = now;
    return {};
  };
  auto same = adopt("camera", used.camera_device, draft.camera_device);
  if (same && used.camera2) {
    if (!draft.camera2) draft.camera2 = used.camera2;
    same = adopt("second camera", used.camera2->device, draft.camera2->device);
  }
  return same ? adopt("projector", used.projector_device, draft.projector_device) : same;
}

NamedFiles named_by(const Options& options) {
  NamedFiles command{options.rig_file.string(), calib::print_board_name(options.board), {}};
  if (command.board == calib::print_board_name(calib::Board{})) command.board.clear();
  if (options.folder != default_folder(options.rig_file)) command.folder = options.folder.string();
  return command;
}

bool has_size_of(const calib::CameraModel& one, const calib::CameraModel& other) {
  return one.width_px == other.width_px && one.height_px == other.height_px;
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
  std::ranges::copy_if(kSteps, std::back_inserter(session.steps_),
                       [&](Step step) { return has_need_of(rig, step); });
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
  if (!has_size_of(draft->camera, used.camera))
    return fail(Errc::bad_config,
                fmt::format("what was measured before, in {}, has images of {}x{} px, and the rig "
                            "has {}x{}; --restart forgets it",
                            session.folder_.string(), draft->camera.width_px,
                            draft->camera.height_px, used.camera.width_px, used.camera.height_px));
  if (draft->camera2 && used.camera2 && !has_size_of(draft->camera2->camera, used.camera2->camera))
    return fail(Errc::bad_config,
                fmt::format("what was measured before, in {}, has images of another size of the "
                            "second camera; --restart forgets it",
                            session.folder_.string()));
  if (auto same = adopt_devices(used, *draft); !same)
    return fail(same.error().code, fmt::format("what was measured before, in {}: {}; --restart "
                                               "forgets it",
                                               session.folder_.string(), same.error().what));
  session.draft_ = *draft;
  return session;
}

bool Session::is_done(Step step) const {
  auto made = draft_.made;
  const auto* sentence = made_of(made, step);
  std::error_code unknown;
  return sentence ? !sentence->empty() : fs::exists(piece_of(step), unknown);
}

bool Session::has_measured() const {
  auto made = draft_.made;
  return std::ranges::any_of(kSteps, [&](Step step) {
    const auto* sentence = made_of(made, step);
    return sentence && !sentence->empty();
  });
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

fs::path Session::piece_of(Step step) const {
  return file(fmt::format("{}.html", config::word_of(step)));
}

void Session::forget(Step step) {
  std::error_code absent;
  if (auto* made = made_of(draft_.made, step)) made->clear();
  fs::remove(piece_of(step), absent);
  fs::remove(settings_of(step), absent);
}

Result<void> Session::keep(Step step, const Outcome& outcome, const calib::Calibration& measured) {
  if (!outcome.is_good)
    return fail(Errc::bad_data,
                "this is not good enough to be used, and was not kept; measure it again");
  draft_ = measured;
  for (const Step later : outdated_by(step)) forget(later);
  auto kept = keep_settings(step, outcome.settings);
  if (auto* made = made_of(draft_.made, step)) {
    *made = fmt::format("{}: {}", local_time("%Y-%m-%d"), outcome.made);
    if (kept) kept = write_whole(file(kPending), "the draft is not in its place yet\n");
  }
  // The measurement before its pictures, for which a disk may have no room.
  if (kept) kept = write_whole(file(kDraft), calib::print_calibration(draft_));
  std::error_code absent;
  if (kept) fs::remove(piece_of(step), absent);  // old figures must not stand under the new ones
  if (kept) kept = write_whole(piece_of(step), piece_html(step, outcome));
  return kept ? write_report() : kept;
}

Result<void> Session::write_report() const {
  std::string pieces;
  for (const Step step : kSteps)
    if (const auto piece = config::read_text(piece_of(step))) pieces += *piece;
  auto made = draft_.made;
  std::vector<Reported> reported;
  for (const Step step : steps_) {
    const auto* sentence = made_of(made, step);
    reported.push_back({step, sentence ? *sentence : std::string(), is_done(step)});
  }
  return write_whole(report(), report_html(rig_name_, command_, reported, pieces));
}

Result<std::string> Session::finish() const {
  // A file that the services would refuse must not take the place of a good one.
  if (const auto usable = calib::load_calibration(file(kDraft)); !usable)
    return tl::make_unexpected(usable.error());
  const auto measured = without_guess(draft_, target_);
  auto sentence = write_and_keep(target_, calib::print_calibration(measured));
  if (!sentence) return sentence;
  std::error_code absent;
  fs::remove(file(kPending), absent);
  return write_whole(file("opencv.yml"), calib::print_opencv_file(measured)).map([&] {
    return "the calibration is in " + *sentence;
  });
}

}  // namespace handcast::calibrate
