// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/second_projector.hpp"

#include <fmt/format.h>

#include "calib/calibration.hpp"
#include "config/settings/quoted.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/calibrate/hand_over.hpp"
#include "services/tools/calibrate/rig_settings.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;

/// The settings that two sections have differently: with the values of `from`, at the place of
/// `to`.
std::vector<std::string> differences(config::Projector from, config::Projector to,
                                     std::string_view place) {
  std::vector<std::string> different;
  const auto values = config::list_settings(from), others = config::list_settings(to);
  for (const auto& section : values)
    for (const auto& setting : section.settings) {
      const auto value = config::print_value(setting);
      if (const auto* other = config::find_setting(others, setting.path);
          other && config::print_value(*other) != value)
        different.push_back(fmt::format("{}.{}={}", place, setting.path, value));
    }
  return different;
}

/// The calibration of the rig, with its second projector as far as it is known.
Result<calib::Calibration> known_so_far(const config::Rig& rig, const Options& options) {
  if (rig.calibration.empty())
    return fail(Errc::bad_config,
                fmt::format("the rig names no calibration, and that of the second projector needs "
                            "the camera of it; measure it first: handcast calibrate {}",
                            options.rig_file.string()));
  auto known = calib::load_calibration(rig.calibration);
  if (!known) return known;
  std::error_code unknown;
  if (const auto& named = rig.projector2.calibration; fs::exists(named, unknown)) {
    const auto second = calib::load_calibration(named);
    if (!second) return tl::make_unexpected(second.error());
    known->projector_device = second->projector_device;
    known->projector = second->projector;
    return known;
  }
  if (options.projector.width_px == 0)
    return fail(Errc::bad_config,
                "the second projector has no calibration, so the size of its image is not known: "
                "add --projector, e.g. --projector 1920x1080");
  known->projector_device.clear();
  known->projector =
      rough_projector({known->camera.width_px, known->camera.height_px}, options.projector);
  return known;
}

}  // namespace

Result<void> turn_to_projector(const config::Rig& rig, Options& options) {
  const auto& second = rig.projector2;
  auto& settings = options.settings;
  if (!options.second_projector) {
    if (second.backend != "none" && second.calibration.empty())
      settings.emplace_back("projector2.backend=none");
    return {};
  }
  if (second.backend == "none")
    return fail(Errc::bad_config,
                "--second-projector: the rig has no second projector; set projector2.backend");
  const auto known = known_so_far(rig, options);
  if (!known) return fail_in("--second-projector", known.error());
  std::error_code failed;
  fs::create_directories(options.folder, failed);
  const auto file = fs::absolute(options.folder) / "known.toml";
  if (auto written = write_whole(file, calib::print_calibration(*known)); !written) return written;
  for (const auto& changed : {differences(second, rig.projector, "projector"),
                              differences(rig.projector, second, "projector2")})
    settings.insert(settings.end(), changed.begin(), changed.end());
  settings.push_back("calibration=" + config::quoted(file.string()));
  settings.push_back("projector2.calibration=" + config::quoted(rig.calibration));
  // The truth of the first one.
  if (rig.twin.geometry.calibration == truth_of(options))
    settings.emplace_back("twin.geometry.calibration=");
  return {};
}

}  // namespace handcast::calibrate
