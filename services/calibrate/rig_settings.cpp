// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/rig_settings.hpp"

#include <fmt/format.h>

#include "calib/board/board_name.hpp"
#include "config/settings/files.hpp"

namespace handcast::calibrate {
namespace {

/// A calibration of which only the sizes are known: a lens as wide as most, and a projector image
/// as large as the camera's.
calib::Calibration from_sizes(Size camera, Size projector) {
  constexpr double kFocalLength_widths = 1.3;
  calib::Calibration rough;
  rough.camera = {camera.width_px,
                  camera.height_px,
                  kFocalLength_widths * camera.width_px,
                  kFocalLength_widths * camera.width_px,
                  (camera.width_px - 1) / 2.0,
                  (camera.height_px - 1) / 2.0};
  rough.projector_width_px = projector.width_px;
  rough.projector_height_px = projector.height_px;
  const double scale_x = static_cast<double>(projector.width_px) / camera.width_px,
               scale_y = static_cast<double>(projector.height_px) / camera.height_px;
  rough.projector_from_camera = {scale_x,           0, 0, 0, scale_y, 0, (scale_x - 1) / 2,
                                 (scale_y - 1) / 2, 1};
  return rough;
}

}  // namespace

Result<RunningAs> rig_as_it_runs(const Options& options, const config::Rig& rig) {
  const bool is_real = rig.camera.backend != "twin";
  const bool has_sizes = options.camera.width_px > 0 && options.projector.width_px > 0;
  if (!rig.calibration.empty() || (!is_real && !has_sizes)) {
    auto calibration = calib::load_calibration(rig.calibration);
    if (!calibration) return tl::make_unexpected(calibration.error());
    return RunningAs{std::move(*calibration), options.settings};
  }
  if (!has_sizes)
    return fail(Errc::bad_config,
                "the rig names no calibration, so the sizes of its images are not known: add "
                "--camera and --projector, e.g. --camera 1280x1024 --projector 1920x1080");
  RunningAs running{from_sizes(options.camera, options.projector), options.settings};
  const auto file = std::filesystem::absolute(options.folder) / "rough.toml";
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (auto written = config::write_whole(file, calib::print_calibration(running.calibration));
      !written)
    return tl::make_unexpected(written.error());
  running.settings.push_back("calibration=" + file.string());
  return running;
}

std::vector<std::string> twin_scene(Step step, const calib::Board& board) {
  std::vector<std::string> settings{
      "projector.rate_hz=60"};  // whole pictures at 946 Hz take a core
  if (step == Step::tracker) {
    settings.emplace_back("twin.motion=builtin:show");
    return settings;
  }
  settings.emplace_back("twin.prop.kind=board");
  settings.push_back("twin.prop.board=" + calib::print_board_name(board));
  settings.push_back(fmt::format("twin.prop.hold_s={}", step == Step::lens ? 1 : 8));
  if (step == Step::screen)
    settings.insert(settings.end(), {"twin.image.leak=1", "twin.image.gain=80"});
  return settings;
}

}  // namespace handcast::calibrate
