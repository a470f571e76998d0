// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/hand_over.hpp"

#include <fmt/format.h>

#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/rig_file_edit.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

/// As a rig file may name it.
std::string name_from(const fs::path& rig_file, const fs::path& file) {
  const bool is_beside = file.parent_path() == fs::absolute(rig_file).parent_path();
  return (is_beside ? file.filename() : file).string();
}

/// Where the truth of a twin is kept.
fs::path truth_of(const Options& options) {
  return fs::absolute(options.rig_file).replace_extension("").string() + "_truth.toml";
}

/// The twin whose truth is whatever calibration the rig names.
bool is_true_by_name(const config::Rig& rig) {
  return rig.camera.backend == "twin" && rig.twin.geometry.calibration.empty();
}

/// Keeps the truth of a twin. A file of an earlier call stays: if its name was not put into the rig
/// file, `running` may be what was measured.
Result<void> keep_truth(const Options& options, const calib::Calibration& running) {
  std::error_code unknown;
  if (fs::exists(truth_of(options), unknown)) return {};
  return write_whole(truth_of(options), calib::print_calibration(running));
}

/// The settings that name files.
std::vector<MeasuredSetting> names_of(const Options& options, const config::Rig& rig,
                                      const Session& session) {
  std::error_code unknown;
  std::vector<MeasuredSetting> names;
  if (!session.has_measured() || !fs::exists(session.target(), unknown)) return names;
  if (fs::path(rig.calibration) != session.target())
    names.push_back({"calibration", name_from(options.rig_file, session.target())});
  if (is_true_by_name(rig) && fs::exists(truth_of(options), unknown))
    names.push_back({"twin.geometry.calibration", name_from(options.rig_file, truth_of(options))});
  return names;
}

}  // namespace

Result<void> hand_over(const Options& options, const config::Rig& rig,
                       const calib::Calibration& running, Session& session) {
  if (session.is_pending()) {
    if (is_true_by_name(rig))
      if (auto kept = keep_truth(options, running); !kept) return kept;
    const auto finished = session.finish();
    if (!finished) return tl::make_unexpected(finished.error());
    fmt::print("{}\n", *finished);
  }
  auto settings = names_of(options, rig, session);
  const auto measured = session.settings();
  settings.insert(settings.end(), measured.begin(), measured.end());
  if (settings.empty()) return {};
  Result<void> applied;
  if (options.apply) {
    const auto sentence = apply_settings(options.rig_file, settings);
    if (sentence) {
      fmt::print("{}:\n", *sentence);
      session.forget_settings();
    } else {
      applied = tl::make_unexpected(sentence.error());
    }
  }
  if (!options.apply || !applied)
    fmt::print("settings for {}{}:\n", options.rig_file.string(),
               options.apply ? "" : ", which --apply writes there");
  for (const auto& setting : settings) fmt::print("  {} = {}\n", setting.path, as_toml(setting));
  return applied;
}

}  // namespace handcast::calibrate
