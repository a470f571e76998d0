// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/device.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::camera::aravis {
namespace {

std::string describe(const Device& device) {
  return fmt::format("{} ({} {}, serial number {}, {})", device.id, device.vendor, device.model,
                     device.serial, device.address);
}

std::string describe(const std::vector<Device>& devices) {
  std::vector<std::string> sentences;
  sentences.reserve(devices.size());
  for (const auto& device : devices) sentences.push_back(describe(device));
  return join(sentences, "; ");
}

bool is_called(const Device& device, const std::string& name) {
  return name == device.id || name == device.serial || name == device.address ||
         name == device.model;
}

bool is_address(const std::string& name) {
  in_addr address{};
  return inet_pton(AF_INET, name.c_str(), &address) == 1;
}

/// GVCP, the control protocol of GigE Vision 1.x: a command begins with 0x42, flags (1: an
/// acknowledgement is wanted), its number, the length of what follows, and an id.
constexpr std::array<std::uint8_t, 8> kDiscovery{0x42, 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01};
constexpr std::uint16_t kGvcpPort = 3956;
constexpr int kAnswer_ms = 20;

bool answers(const std::string& address) {
  sockaddr_in camera{};
  camera.sin_family = AF_INET;
  camera.sin_port = htons(kGvcpPort);
  if (inet_pton(AF_INET, address.c_str(), &camera.sin_addr) != 1) return false;
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket ||
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&camera), sizeof(camera)) != 0)
    return false;
  if (::send(socket.get(), kDiscovery.data(), kDiscovery.size(), MSG_NOSIGNAL) < 0) return false;
  pollfd wait{socket.get(), POLLIN, 0};
  std::array<std::uint8_t, 512> reply{};
  return ::poll(&wait, 1, kAnswer_ms) > 0 &&
         ::recv(socket.get(), reply.data(), reply.size(), 0) > 0;
}

bool is_on_the_usb(const Device& device) {
  auto* usb = arv_uv_interface_get_instance();
  arv_interface_update_device_list(usb);
  for (unsigned i = 0; i < arv_interface_get_n_devices(usb); ++i)
    if (text_of(arv_interface_get_device_id(usb, i)) == device.id) return true;
  return false;
}

}  // namespace

std::vector<Device> list_devices() {
  arv_update_device_list();
  std::vector<Device> devices;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i)
    devices.push_back({.id = text_of(arv_get_device_id(i)),
                       .serial = text_of(arv_get_device_serial_nbr(i)),
                       .address = text_of(arv_get_device_address(i)),
                       .vendor = text_of(arv_get_device_vendor(i)),
                       .model = text_of(arv_get_device_model(i)),
                       .protocol = text_of(arv_get_device_protocol(i))});
  return devices;
}

std::vector<Device> devices_called(const std::string& name) {
  if (is_address(name) && answers(name))
    return {{.id = name,
             .serial = "",
             .address = name,
             .vendor = "",
             .model = "",
             .protocol = "GigEVision"}};
  auto devices = list_devices();
  if (!name.empty())
    std::erase_if(devices, [&](const Device& device) { return !is_called(device, name); });
  return devices;
}

Result<Device> find_device(const std::string& name) {
  const auto devices = devices_called(name);
  if (devices.size() == 1) return devices.front();
  if (!devices.empty())
    return fail(Errc::bad_config,
                fmt::format("several cameras are attached; set aravis.device to the serial "
                            "number of one: {}",
                            describe(devices)));
  const auto others = name.empty() ? devices : list_devices();
  if (others.empty())
    return fail(Errc::unavailable,
                "no GigE Vision or USB3 Vision camera is attached, or none answers");
  return fail(Errc::unavailable,
              fmt::format("there is no camera {}, but {}", quote(name), describe(others)));
}

Result<Owned<ArvCamera>> open_device(const Device& device) {
  const auto& name = device.is_gige() ? device.address : device.id;
  auto* opened = device.is_gige() ? arv_gv_interface_get_instance() : nullptr;
  if (device.protocol == "USB3Vision") opened = arv_uv_interface_get_instance();
  const auto raw = opened
                       ? ask([&](GError** error) {
                           return arv_interface_open_device(opened, name.c_str(), error);
                         })
                       : ask([&](GError** error) { return arv_open_device(name.c_str(), error); });
  if (!raw) return tl::make_unexpected(raw.error());
  if (!*raw) return fail(Errc::unavailable, fmt::format("camera {} does not answer", name));
  const Owned<ArvDevice> owned(*raw);
  if (ARV_IS_GV_DEVICE(owned.get()) && !arv_gv_device_is_controller(ARV_GV_DEVICE(owned.get())))
    return fail(Errc::unavailable,
                fmt::format("camera {} is controlled by another program; end it first", name));
  const auto camera =
      ask([&](GError** error) { return arv_camera_new_with_device(owned.get(), error); });
  if (!camera) return tl::make_unexpected(camera.error());
  return Owned<ArvCamera>(*camera);
}

Device with_its_names(ArvCamera* camera, Device device) {
  const auto learn = [&](std::string& name, auto* call) {
    const auto said = ask([&](GError** error) { return text_of(call(camera, error)); });
    if (said && !said->empty()) name = *said;
  };
  learn(device.serial, arv_camera_get_device_serial_number);
  learn(device.vendor, arv_camera_get_vendor_name);
  learn(device.model, arv_camera_get_model_name);
  return device;
}

Result<Sensor> sensor_of(ArvCamera* camera) {
  Sensor sensor;
  const auto size = ask([&](GError** error) {
    gint most = 0;  // depends on the present corner
    arv_camera_get_width_bounds(camera, &sensor.least_width_px, &most, error);
    if (!*error) arv_camera_get_height_bounds(camera, &sensor.least_height_px, &most, error);
    if (!*error) arv_camera_get_sensor_size(camera, &sensor.width_px, &sensor.height_px, error);
  });
  if (!size) return tl::make_unexpected(size.error());
  double least_hz = 0;
  const auto rate = ask([&](GError** error) {
    arv_camera_get_frame_rate_bounds(camera, &least_hz, &sensor.rate_hz, error);
  });
  if (!rate) sensor.rate_hz = 0;
  return sensor;
}

std::array<std::string, 4> names_of(const Device& device) {
  return {device.serial, device.id, device.address,
          device.model.empty() ? "" : fmt::format("{} {}", device.vendor, device.model)};
}

namespace {

/// Names without the empty ones.
std::vector<std::string> known(const std::array<std::string, 4>& names) {
  std::vector<std::string> those(names.begin(), names.end());
  std::erase(those, "");
  return those;
}

std::string name_of(const Device& device) {
  if (device.serial.empty()) return "camera " + device.id;
  return fmt::format("{} {}, serial number {}", device.vendor, device.model, device.serial);
}

daemon::Attached entry_of(const Device& device) {
  const auto names = known(names_of(device));
  return {.kind = daemon::Kind::camera,
          .name = name_of(device),
          .about = fmt::format("{} at {}", device.protocol, device.address),
          .settings = {{"camera.backend", "aravis"},
                       {"camera.aravis.device", names.empty() ? "" : names.front()}},
          .names = names};
}

/// Opens the camera, to see whether that is possible and what it can do.
daemon::Attached look_into(const Device& device) {
  const auto opened = open_device(device);
  auto entry = entry_of(opened ? with_its_names(opened->get(), device) : device);
  if (!opened) {
    entry.trouble = opened.error().what;
  } else if (const auto sensor = sensor_of(opened->get())) {
    entry.modes.push_back({.format = "",
                           .least_width_px = sensor->least_width_px,
                           .least_height_px = sensor->least_height_px,
                           .width_px = sensor->width_px,
                           .height_px = sensor->height_px,
                           .rate_hz = sensor->rate_hz});
  }
  return entry;
}

}  // namespace

std::vector<daemon::Attached> attached(const daemon::Search& search) {
  std::vector<daemon::Attached> all;
  for (const auto& device : devices_called(search.name))
    all.push_back(search.opens ? look_into(device) : entry_of(device));
  return all;
}

bool Presence::is_there() const {
  if (device_.is_gige()) return answers(device_.address);
  return device_.protocol != "USB3Vision" || is_on_the_usb(device_);
}

}  // namespace handcast::camera::aravis
