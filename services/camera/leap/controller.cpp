// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/camera/leap/lens_fit.hpp"

namespace handcast::camera::leap {
namespace {

constexpr int kSerialAddress = 0;
constexpr std::size_t kSerialBytes = 13;
/// The time that the controller takes to find a byte.
constexpr std::int64_t kFind_ns = 4'000'000;

/// Empty if the memory has no serial number there.
std::string serial_of(UsbDevice& device) {
  const auto bytes = read_memory(device, kSerialAddress, kSerialBytes);
  if (!bytes) return {};
  std::string serial(bytes->begin(), bytes->end());
  const bool is_text = std::ranges::all_of(serial, [](char letter) {
    return (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z');
  });
  return is_text ? serial : std::string();
}

Result<Controller> open_at(const std::string& port) {
  auto device = UsbDevice::open(port);
  if (!device) return tl::make_unexpected(device.error());
  auto serial = serial_of(*device);
  return Controller{std::move(*device), port, std::move(serial)};
}

Result<Controller> open_by_serial(const std::string& wanted,
                                  const std::vector<std::string>& ports) {
  std::vector<std::string> others;
  std::optional<Error> why;
  for (const auto& port : ports) {
    auto controller = open_at(port);
    if (controller && controller->serial == wanted) return controller;
    if (!controller) why = controller.error();
    others.push_back(controller && !controller->serial.empty()
                         ? fmt::format("{} (port {})", controller->serial, port)
                         : fmt::format("port {}", port));
  }
  return fail(Errc::unavailable, fmt::format("no controller {}; there are: {}{}", quote(wanted),
                                             join(others, ", "), why ? "; " + why->what : ""));
}

}  // namespace

Result<Controller> open_controller(const std::string& wanted) {
  const auto ports = controller_ports();
  if (ports.empty()) return fail(Errc::unavailable, "no Leap Motion Controller is attached");
  if (std::ranges::find(ports, wanted) != ports.end()) return open_at(wanted);
  if (!wanted.empty()) return open_by_serial(wanted, ports);
  if (ports.size() == 1) return open_at(ports.front());
  return fail(Errc::bad_config,
              fmt::format("leap.device: several controllers are attached, at the USB ports {}",
                          join(ports, ", ")));
}

Result<std::vector<std::uint8_t>> read_memory(UsbDevice& device, int address, std::size_t count) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = static_cast<std::uint16_t>(address + static_cast<int>(i));
    if (auto set = device.write(set_control(kMemoryAddress, place)); !set)
      return tl::make_unexpected(set.error());
    sleep_until_ns(now_ns() + kFind_ns);
    const auto byte = device.read(get_control(kMemoryByte));
    if (!byte) return tl::make_unexpected(byte.error());
    if (byte->empty()) return fail(Errc::bad_data, "the controller reads no memory");
    bytes.push_back(byte->front());
  }
  return bytes;
}

Result<ControllerCalibration> read_calibration(UsbDevice& device) {
  const auto block = read_memory(device, kCalibrationAddress, kCalibrationBytes);
  if (!block) return fail_in("calibration of the controller", block.error());
  auto calibration = parse_calibration(*block);
  if (!calibration) return fail_in("calibration of the controller", calibration.error());
  return calibration;
}

Result<std::string> calibration_file_from(const std::string& wanted, bool of_right_eye,
                                          int width_px, int height_px) {
  auto controller = open_controller(wanted);
  if (!controller) return tl::make_unexpected(controller.error());
  const auto calibration = read_calibration(controller->device);
  if (!calibration) return tl::make_unexpected(calibration.error());
  return calibration_file_of(*calibration, controller->serial,
                             of_right_eye ? config::Eye::right : config::Eye::left, width_px,
                             height_px);
}

}  // namespace handcast::camera::leap
