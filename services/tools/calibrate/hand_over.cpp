// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/hand_over.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/quoted.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/kept_file.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

/// As a rig file may name it, in quotes.
std::string name_from(const fs::path& rig_file, const fs::path& file) {
  const bool is_beside = file.parent_path() == fs::absolute(rig_file).parent_path();
  return config::quoted((is_beside ? file.filename() : file).string());
}

/// The twin whose truth is whatever calibration the rig names.
bool is_true_by_name(const Options& options, const config::Rig& rig) {
  return !options.second_projector && rig.camera.backend == "twin" &&
         rig.twin.geometry.calibration.empty();
}

/// Keeps the truth of a twin. A file of an earlier call stays: if its name was not put into the rig
/// file, `running` may be what was measured.
Result<void> keep_truth(const Options& options, const calib::Calibration& running) {
  std::error_code unknown;
  if (fs::exists(truth_of(options), unknown)) return {};
  return write_whole(truth_of(options), calib::print_calibration(running));
}

/// The settings that name files.
std::vector<config::MeasuredSetting> names_of(const Options& options, const config::Rig& rig,
                                              const Session& session) {
  std::error_code unknown;
  std::vector<config::MeasuredSetting> names;
  if (!session.has_measured() || !fs::exists(session.target(), unknown)) return names;
  if (fs::path(rig.calibration) != session.target())
    names.push_back({"calibration", name_from(options.rig_file, session.target())});
  if (is_true_by_name(options, rig) && fs::exists(truth_of(options), unknown))
    names.push_back({"twin.geometry.calibration", name_from(options.rig_file, truth_of(options))});
  return names;
}

/// Where the rig has what was measured of its second projector.
std::string of_second_projector(const std::string& path) {
  return path == "calibration" ? "projector2.calibration"
                               : config::name_at_projector(config::Viewpoint::second, path);
}

std::string heading_of(const fs::path& rig_file) {
  return fmt::format(
      "# Measured values, which win over those of {0}. `handcast calibrate --apply` wrote\n"
      "# this file at {1}; without it the rig has the values of {0} again.\n",
      rig_file.filename().string(), local_time("%Y-%m-%d %H:%M"));
}

/// Writes settings to the file of measured ones; others that it has stay. `above`: see
/// write_and_keep(). Returns a sentence.
Result<std::string> apply_settings(const fs::path& rig_file,
                                   std::span<const config::MeasuredSetting> settings, int above) {
  const auto file = config::measured_file_of(rig_file);
  const auto before = config::read_measured(file);
  if (!before) return tl::make_unexpected(before.error());
  auto all = *before;
  for (const auto& setting : settings) {
    const auto same = std::ranges::find(all, setting.path, &config::MeasuredSetting::path);
    if (same == all.end())
      all.push_back(setting);
    else
      same->value = setting.value;
  }
  const auto text = heading_of(rig_file) + config::print_measured(all);
  const auto after = config::parse_measured(text, file);
  if (!after) return tl::make_unexpected(after.error());
  if (*after == *before) return fmt::format("{} has these settings already", file.string());
  std::error_code unknown;
  if (!fs::exists(file, unknown))  // so that undo() has something to put back
    if (auto first = write_whole(file, heading_of(rig_file)); !first)
      return tl::make_unexpected(first.error());
  return write_and_keep(file, text, above).map([&](const std::string& written) {
    return fmt::format(
        "measured settings, which win over those of {0}, are in {1}; `handcast calibrate {0} "
        "--undo` takes them back",
        rig_file.string(), written);
  });
}

}  // namespace

fs::path truth_of(const Options& options) {
  return fs::absolute(options.rig_file).replace_extension("").string() + "_truth.toml";
}

Result<void> hand_over(const Options& options, const config::Rig& rig,
                       const calib::Calibration& running, Session& session) {
  const auto file = config::measured_file_of(options.rig_file);
  const int above =
      newest_number({rig.calibration, rig.projector2.calibration, session.target(), file});
  if (session.is_pending()) {
    if (is_true_by_name(options, rig))
      if (auto kept = keep_truth(options, running); !kept) return kept;
    const auto finished = session.finish(above);
    if (!finished) return tl::make_unexpected(finished.error());
    fmt::print("{}\n", *finished);
  }
  auto settings = names_of(options, rig, session);
  const auto measured = session.settings();
  settings.insert(settings.end(), measured.begin(), measured.end());
  if (options.second_projector)
    for (auto& setting : settings) setting.path = of_second_projector(setting.path);
  if (settings.empty()) return {};
  const auto applied = options.apply
                           ? apply_settings(options.rig_file, settings, above)
                           : fmt::format("settings, which --apply writes to {}", file.string());
  fmt::print("{}:\n", applied ? *applied : "measured settings, which could not be written");
  for (const auto& [path, value] : settings) fmt::print("  {} = {}\n", path, value);
  if (!applied) return tl::make_unexpected(applied.error());
  if (options.apply) session.forget_settings();
  return {};
}

Result<void> undo(const Options& options, const config::Rig& rig) {
  const auto measured = config::measured_file_of(fs::absolute(options.rig_file));
  const auto& second = rig.projector2.calibration;
  const auto newest = newest_number({rig.calibration, second, measured});
  if (newest == 0)
    return fail(Errc::bad_config, fmt::format("nothing is kept of {} that could be taken back",
                                              options.rig_file.string()));
  const auto take = [&](const fs::path& file, const IsUsable& is_usable) -> Result<void> {
    if (newest_number({file}) != newest) return {};
    return take_back(file, is_usable).map([](const auto& done) { fmt::print("{}\n", done); });
  };
  const auto is_calibration = [](const fs::path& kept) {
    return calib::load_calibration(kept).map([](const auto&) {});
  };
  auto taken = take(rig.calibration, is_calibration);
  if (taken) taken = take(second, is_calibration);
  if (taken)
    taken = take(measured, [](const fs::path& kept) {
      return config::read_measured(kept).map([](const auto&) {});
    });
  return taken.map([] { fmt::print("`handcast reload` applies it\n"); });
}

}  // namespace handcast::calibrate
