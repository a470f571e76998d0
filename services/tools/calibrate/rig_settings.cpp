// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/rig_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "config/second_view.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::calibrate {
namespace {

/// A lens as wide as most.
calib::CameraModel usual_lens(Size size) {
  constexpr double kFocalLength_widths = 1.3;
  return {size.width_px,
          size.height_px,
          kFocalLength_widths * size.width_px,
          kFocalLength_widths * size.width_px,
          (size.width_px - 1) / 2.0,
          (size.height_px - 1) / 2.0};
}

/// A calibration of which only the sizes are known.
calib::Calibration from_sizes(Size camera, Size projector) {
  calib::Calibration rough;
  rough.camera = usual_lens(camera);
  rough.projector = rough_projector(camera, projector);
  return rough;
}

/// A second camera of which only the size is known: a hand's width to the right of the first one.
calib::SecondCamera guessed_second(const Options& options, const calib::CameraModel& first) {
  constexpr double kApart_m = 0.1;
  auto size = options.camera2;
  if (size.width_px == 0) size = {first.width_px, first.height_px};
  glm::dmat4 from_first(1);
  from_first[3].x = -kApart_m;
  return {{}, usual_lens(size), from_first};
}

/// Writes a calibration to the session's folder, for the services.
Result<RunningAs> run_with(const Options& options, calib::Calibration calibration,
                           bool is_second_guessed, std::string new_devices) {
  RunningAs running{std::move(calibration), options.settings, std::move(new_devices),
                    is_second_guessed};
  const auto file = std::filesystem::absolute(options.folder) / "rough.toml";
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (auto written = write_whole(file, calib::print_calibration(running.calibration)); !written)
    return tl::make_unexpected(written.error());
  running.settings.push_back("calibration=" + file.string());
  return running;
}

/// What a calibration and a rig have differently; empty if they have the same devices, or these are
/// not known.
std::string other_devices(const calib::Calibration& calibration, const OwnDevices& own) {
  const auto differ = [](const std::string& before, const std::vector<std::string>& names) {
    return !before.empty() && !names.empty() && std::ranges::count(names, before) == 0;
  };
  if (differ(calibration.camera_device, own.camera_names))
    return fmt::format("the camera '{}', and the rig has '{}'", calibration.camera_device,
                       own.camera);
  if (calibration.camera2 && differ(calibration.camera2->device, own.camera2_names))
    return fmt::format("the second camera '{}', and the rig has '{}'", calibration.camera2->device,
                       own.camera2);
  if (differ(calibration.projector_device, own.projector_names))
    return fmt::format("the projector '{}', and the rig has '{}'", calibration.projector_device,
                       own.projector);
  return {};
}

/// The names of devices as a part of a file's name: letters and digits; "new" if there are none.
std::string slug_of(const OwnDevices& own) {
  std::string slug;
  for (const char c : own.camera + "_" + own.camera2 + "_" + own.projector) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_plain || (!slug.empty() && slug.back() != '_')) slug += is_plain ? c : '_';
  }
  while (!slug.empty() && slug.back() == '_') slug.pop_back();
  return slug.empty() ? "new" : slug;
}

/// Error bad_config: a size was given which has no effect.
Result<void> check_size(const char* flag, Size given, Size in_use) {
  if (given.width_px == 0 ||
      (given.width_px == in_use.width_px && given.height_px == in_use.height_px))
    return {};
  return fail(
      Errc::bad_config,
      fmt::format("{} {}x{} has no effect: the calibration that the rig names has {}x{}; "
                  "for images of another size take `calibration` out of the rig file",
                  flag, given.width_px, given.height_px, in_use.width_px, in_use.height_px));
}

/// The option that compares something with the calibration in use; null if there is none.
const char* what_compares(const Options& options) {
  return options.check             ? "--check"
         : options.correct         ? "--correct"
         : !options.points.empty() ? "--points"
                                   : nullptr;
}

Result<void> no_tracker(std::string_view asked, const config::Rig& rig) {
  const auto* why = rig.pose.backend == "none"
                        ? "the rig has no poses (pose.backend is none), so there is no tracker to "
                          "measure"
                        : "the poses of this rig come from its cameras, so there is no tracker to "
                          "measure; if a camera has moved, measure `pair` (and `screen`) again";
  return fail(Errc::bad_config, fmt::format("{}: {}", asked, why));
}

Result<void> no_second_camera(std::string_view asked) {
  return fail(Errc::bad_config,
              fmt::format("{}: the rig has no second camera; set camera2.backend", asked));
}

/// A device as a rig file asks for it.
struct Wanted {
  std::pair<std::string, std::string> backend;  ///< the setting and its value
  std::string name;                             ///< empty: whichever fits
};

/// Nothing if the back end has no devices.
std::optional<Wanted> camera_of(const config::Camera& camera) {
  const auto named = [&](const std::string& name) {
    return Wanted{{"camera.backend", camera.backend}, name};
  };
  if (camera.backend == "aravis") return named(camera.aravis.device);
  if (camera.backend == "v4l2") return named(camera.v4l2.device);
  return {};
}

std::optional<Wanted> projector_of(const config::Projector& projector) {
  const auto named = [&](const std::string& name) {
    return Wanted{{"projector.backend", projector.backend}, name};
  };
  if (projector.backend == "kms") return named(projector.kms.connector);
  if (projector.backend == "window") return named(projector.window.monitor);
  return {};
}

/// A number or a file says where a device is now, and not which one it is.
bool is_lasting(const std::string& name) {
  return !name.starts_with("/dev/") &&
         !std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The only device that fits; null if there are several or none.
const devices::Attached* only_fitting(const Wanted& wanted,
                                      const std::vector<devices::Attached>& attached) {
  std::vector<const devices::Attached*> fitting;
  for (const auto& device : attached)
    if (!device.names.empty() &&
        std::ranges::find(device.settings, wanted.backend) != device.settings.end() &&
        (wanted.name.empty() || std::ranges::count(device.names, wanted.name) > 0))
      fitting.push_back(&device);
  return fitting.size() == 1 ? fitting.front() : nullptr;
}

/// Sets the most telling name of a device, and all of its names.
void name_device(const std::optional<Wanted>& wanted,
                 const std::vector<devices::Attached>& attached, std::string& name,
                 std::vector<std::string>& names) {
  if (!wanted) return;
  if (const auto* device = only_fitting(*wanted, attached)) {
    name = device->names.front();
    names.assign(device->names.begin(), device->names.end());
  } else if (is_lasting(wanted->name)) {
    name = wanted->name;
  }
}

}  // namespace

OwnDevices own_devices(const config::Rig& rig, const std::vector<devices::Attached>& attached) {
  OwnDevices own;
  name_device(camera_of(rig.camera), attached, own.camera, own.camera_names);
  name_device(camera_of(rig.camera2), attached, own.camera2, own.camera2_names);
  name_device(projector_of(rig.projector), attached, own.projector, own.projector_names);
  return own;
}

OwnDevices own_devices(const config::Rig& rig) {
  std::vector<devices::Attached> attached;
  const auto look_for = [&](devices::Kind kind) {
    for (auto& device : devices::attached_of(kind)) attached.push_back(std::move(device));
  };
  if (camera_of(rig.camera) || camera_of(rig.camera2)) look_for(devices::Kind::camera);
  if (projector_of(rig.projector)) look_for(devices::Kind::display);
  return own_devices(rig, attached);
}

calib::ProjectorModel rough_projector(Size camera, Size projector) {
  calib::ProjectorModel rough;
  rough.width_px = projector.width_px;
  rough.height_px = projector.height_px;
  const double scale_x = static_cast<double>(projector.width_px) / camera.width_px,
               scale_y = static_cast<double>(projector.height_px) / camera.height_px;
  rough.from_camera = {scale_x, 0, 0, 0, scale_y, 0, (scale_x - 1) / 2, (scale_y - 1) / 2, 1};
  return rough;
}

bool has_need_of(const config::Rig& rig, Step step) {
  if (step == Step::lens2 || step == Step::pair) return config::has_second_view(rig);
  return step != Step::tracker || (rig.pose.backend != "none" && rig.pose.backend != "stereo");
}

Result<void> check_steps(const Options& options, const config::Rig& rig) {
  if (const auto* asked = what_compares(options);
      asked && rig.calibration.empty() && rig.camera.backend != "twin")
    return fail(Errc::bad_config,
                fmt::format("{} needs a calibration, and the rig names none; measure one first: "
                            "handcast calibrate {}",
                            asked, options.rig_file.string()));
  const bool has_tracker = has_need_of(rig, Step::tracker);
  if (options.correct && !has_tracker) return no_tracker("--correct", rig);
  if (options.reflector_mm > 0 && !has_tracker) return no_tracker("--reflector", rig);
  if (options.camera2.width_px > 0 && !has_need_of(rig, Step::pair))
    return no_second_camera("--camera2");
  const auto missing =
      std::ranges::find_if(options.steps, [&](Step step) { return !has_need_of(rig, step); });
  if (missing == options.steps.end()) return {};
  const auto word = config::word_of(*missing);
  if (*missing == Step::tracker) return no_tracker(word, rig);
  return no_second_camera(word);
}

Result<RunningAs> rig_as_it_runs(const Options& options, const config::Rig& rig,
                                 const OwnDevices& own) {
  const bool is_real = rig.camera.backend != "twin";
  const bool has_sizes = options.camera.width_px > 0 && options.projector.width_px > 0;
  std::string others;
  if (!rig.calibration.empty() || (!is_real && !has_sizes)) {
    auto calibration = calib::load_calibration(rig.calibration);
    if (!calibration) return tl::make_unexpected(calibration.error());
    others = other_devices(*calibration, own);
    const bool lacks_second = config::has_second_view(rig) && !calibration->camera2;
    if (lacks_second) calibration->camera2 = guessed_second(options, calibration->camera);
    if (others.empty() && lacks_second) return run_with(options, std::move(*calibration), true, {});
    if (others.empty()) return RunningAs{std::move(*calibration), options.settings, {}};
    if (const auto* asked = what_compares(options))
      return fail(Errc::bad_config,
                  fmt::format("{} was made with {}; {} needs a calibration of the "
                              "devices that the rig has now",
                              rig.calibration, others, asked));
    if (!has_sizes)
      return fail(
          Errc::bad_config,
          fmt::format("{} was made with {}; to calibrate the new one, too, add the sizes of "
                      "the images, e.g. --camera 1280x1024 --projector {}x{}: it gets a "
                      "file of its own, and the old one stays",
                      rig.calibration, others, calibration->projector.width_px,
                      calibration->projector.height_px));
  }
  if (!has_sizes)
    return fail(Errc::bad_config,
                "the rig names no calibration, so the sizes of its images are not known: add "
                "--camera and --projector, e.g. --camera 1280x1024 --projector 1920x1080");
  auto rough = from_sizes(options.camera, options.projector);
  if (config::has_second_view(rig)) rough.camera2 = guessed_second(options, rough.camera);
  return run_with(options, std::move(rough), false, others.empty() ? std::string() : slug_of(own));
}

Result<void> check_known(const Options& options, const RunningAs& running) {
  const auto* asked = what_compares(options);
  if (asked && options.points.empty() && running.is_second_guessed)
    return fail(Errc::bad_config,
                fmt::format("{}: the second camera is not calibrated yet; measure it first: "
                            "handcast calibrate {} lens2 pair",
                            asked, options.rig_file.string()));
  auto same =
      check_size("--camera", options.camera,
                 {running.calibration.camera.width_px, running.calibration.camera.height_px});
  if (same)
    same = check_size(
        "--projector", options.projector,
        {running.calibration.projector.width_px, running.calibration.projector.height_px});
  if (same && running.calibration.camera2)
    same = check_size("--camera2", options.camera2,
                      {running.calibration.camera2->camera.width_px,
                       running.calibration.camera2->camera.height_px});
  return same;
}

}  // namespace handcast::calibrate
