// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/devices.hpp"

#include <fmt/format.h>

#include "calib/calibration.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/camera/v4l2/list.hpp"
#ifdef HANDCAST_WITH_LIBUSB
#include "services/camera/leap/controller.hpp"
#endif
#ifdef HANDCAST_WITH_HIDAPI
#include "services/projector/dlp/choose_device.hpp"
#endif

namespace handcast::doctor {
namespace {

/// A device that a service would find.
struct FoundDevice {
  std::string text;                ///< for people
  std::vector<std::string> names;  ///< that a calibration may give it
};

[[maybe_unused]] tl::unexpected<Error> not_in_build(std::string_view backend) {
  return fail(Errc::bad_config, fmt::format("this build has no back end '{}'", backend));
}

Result<FoundDevice> aravis_camera(const config::Camera& settings, Asking asking) {
  const auto& name = settings.aravis.device;
  const auto found =
      devices::cameras_of_files({.name = name, .opens = asking == Asking::now}, "aravis");
  if (found.empty())
    return fail(Errc::unavailable, name.empty() ? "no GigE Vision or USB3 Vision camera answers"
                                                : "there is no camera " + quote(name));
  const auto& camera = found.front();
  if (found.size() > 1)
    return fail(Errc::bad_config,
                "several cameras are attached; set aravis.device to the serial "
                "number of one");
  if (!camera.trouble.empty())
    return fail(camera.names.empty() ? Errc::bad_config : Errc::unavailable, camera.trouble);
  return FoundDevice{fmt::format("{}, {}", camera.name, camera.about), camera.names};
}

Result<FoundDevice> webcam(const config::Camera& settings, Asking asking) {
  using namespace camera::v4l2;
  const auto device = find_device(settings.v4l2.device);
  if (!device) return tl::make_unexpected(device.error());
  const auto& identity = device->identity;
  if (asking == Asking::now)
    for (const auto& listed : list_cameras())
      if (listed.identity.path == identity.path && !listed.trouble.empty())
        return fail(Errc::unavailable, listed.trouble);
  return FoundDevice{describe(identity), {identity.card, identity.bus, identity.path}};
}

Result<FoundDevice> leap_controller([[maybe_unused]] const config::Camera& settings,
                                    [[maybe_unused]] Asking asking) {
#ifdef HANDCAST_WITH_LIBUSB
  using namespace camera::leap;
  if (asking == Asking::not_now) {
    const auto ports = controller_ports();
    if (ports.empty()) return fail(Errc::unavailable, "no Leap Motion Controller is attached");
    return FoundDevice{"Leap Motion Controller at USB " + join(ports, ", "), {}};
  }
  const auto controller = open_controller(settings.leap.device);
  if (!controller) return tl::make_unexpected(controller.error());
  return FoundDevice{
      fmt::format("Leap Motion Controller {} at USB {}", controller->serial, controller->port),
      {controller->serial, controller->port}};
#else
  return not_in_build("leap");
#endif
}

/// nullopt: the back end has no device.
std::optional<Result<FoundDevice>> camera_of(const config::Camera& settings, Asking asking) {
  if (settings.backend == "aravis") return aravis_camera(settings, asking);
  if (settings.backend == "v4l2") return webcam(settings, asking);
  if (settings.backend == "leap") return leap_controller(settings, asking);
  return std::nullopt;
}

/// Whether it is the camera of the calibration. An error of the calibration is another finding.
Result<void> is_calibrated(const config::Rig& rig, config::Viewpoint at, const FoundDevice& found) {
  const auto calibration = calib::load_calibration(rig.calibration);
  if (!calibration || found.names.empty()) return {};
  const auto camera = calib::camera_at(*calibration, at);
  if (!camera) return {};
  for (const auto& name : found.names)
    if (name == camera->device) return {};
  return calib::check_device("camera", camera->device, {found.names.front()});
}

Finding missing(std::string check, const Error& error, devices::Kind kind) {
  if (error.code == Errc::bad_config)
    return {std::move(check), Grade::fault, error.what,
            "`handcast devices` lists what is attached"};
  return {std::move(check), Grade::fault, error.what,
          "`handcast up` waits for it; " + instead_of_missing(kind, devices::attached_of(kind))};
}

void examine_camera(const config::Rig& rig, config::Viewpoint at, Asking asking,
                    std::vector<Finding>& findings) {
  const auto found = camera_of(config::camera_at(rig, at), asking);
  if (!found) return;
  auto check = config::name_at(at, "camera") + " device";
  if (!*found)
    return findings.push_back(missing(std::move(check), found->error(), devices::Kind::camera));
  const auto ours = is_calibrated(rig, at, **found);
  findings.push_back(ours ? Finding{check, Grade::good, (*found)->text, ""}
                          : Finding{check, Grade::fault, ours.error().what,
                                    "`handcast devices` lists what is attached"});
}

Result<FoundDevice> dlp_controller([[maybe_unused]] const config::Dlp& settings,
                                   [[maybe_unused]] Asking asking) {
#ifdef HANDCAST_WITH_HIDAPI
  const auto info = dlp::choose_device(settings.device);
  if (!info) return tl::make_unexpected(info.error());
  FoundDevice found{
      fmt::format("{}, serial number {}, {}", info->product, info->serial, info->path), {}};
  if (asking == Asking::not_now) return found;
  const auto opened = dlp::HidDevice::open(*info);
  return opened ? Result<FoundDevice>(found) : tl::make_unexpected(opened.error());
#else
  return not_in_build("lightcrafter");
#endif
}

}  // namespace

std::string instead_of_missing(devices::Kind kind, const std::vector<devices::Attached>& attached) {
  std::vector<std::string> names;
  for (const auto& device : attached)
    if (device.kind == kind && !device.names.empty())
      names.push_back(fmt::format("{} ({} = \"{}\")", device.name, device.settings.front().first,
                                  device.settings.front().second));
  if (!names.empty()) return "attached: " + join(names, "; ");
  const auto kinds = devices::kKindNames[static_cast<std::size_t>(kind)];
  return fmt::format("no {} is attached", kinds.substr(0, kinds.size() - 1));
}

std::vector<Finding> examine_devices(const config::Rig& rig, Asking asking) {
  std::vector<Finding> findings;
  examine_camera(rig, config::Viewpoint::first, asking, findings);
  examine_camera(rig, config::Viewpoint::second, asking, findings);
  if (rig.dlp.backend == "none") return findings;
  const auto controller = dlp_controller(rig.dlp, asking);
  findings.push_back(controller
                         ? Finding{"dlp device", Grade::good, controller->text, ""}
                         : missing("dlp device", controller.error(), devices::Kind::controller));
  return findings;
}

}  // namespace handcast::doctor
