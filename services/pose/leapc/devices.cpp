// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "services/pose/leapc/connection.hpp"

namespace handcast::pose::leapc {
namespace {

constexpr std::uint32_t kLongestSerial = 256;
/// The size of DeviceInfo before the firmware's version was added.
constexpr std::uint32_t kSmallInfo = offsetof(DeviceInfo, firmware);

}  // namespace

void Devices::clear() {
  for (const auto& [id, device] : devices_)
    if (device.handle) call_.close_device(device.handle);
  devices_.clear();
}

std::string Devices::serial_of(DeviceHandle device) const {
  for (const std::uint32_t size : {std::uint32_t{sizeof(DeviceInfo)}, kSmallInfo}) {
    std::vector<char> serial(kLongestSerial + 1);
    DeviceInfo info{};
    info.size = size;
    info.serial = serial.data();
    info.serial_length = kLongestSerial;
    if (call_.device_info(device, &info) == kSuccess) return {serial.data()};
  }
  return {};
}

void Devices::attached(ConnectionHandle connection, const DeviceEvent& event) {
  Device device;
  if (call_.open_device(event.device, &device.handle) != kSuccess) device.handle = nullptr;
  if (device.handle) device.serial = serial_of(device.handle);
  const std::string name = device.serial.empty() ? "without a serial number" : device.serial;
  if (!is_wanted(device)) {
    log::info("pose 'leapc': device {} is left alone; pose.leapc.device is {}", name, wanted_);
  } else {
    log::info("pose 'leapc': device {} is attached", name);
    if (!wanted_.empty() && device.handle && call_.subscribe)
      call_.subscribe(connection, device.handle);
  }
  const bool is_kept = !wanted_.empty() && is_wanted(device);
  if (device.handle && !is_kept) {
    call_.close_device(device.handle);
    device.handle = nullptr;
  }
  lost(event);  // announced twice
  devices_[event.device.id] = std::move(device);
}

void Devices::lost(const DeviceEvent& event) {
  const auto found = devices_.find(event.device.id);
  if (found == devices_.end()) return;
  if (found->second.handle) call_.close_device(found->second.handle);
  devices_.erase(found);
}

bool Devices::is_wanted(std::uint32_t id) const {
  const auto found = devices_.find(id);
  return id == 0 || found == devices_.end() ? wanted_.empty() || id == 0 : is_wanted(found->second);
}

std::string Devices::trouble() const {
  if (devices_.empty()) return "no device is attached to Ultraleap's service";
  const bool is_there =
      std::ranges::any_of(devices_, [this](const auto& entry) { return is_wanted(entry.second); });
  if (is_there) return {};
  std::vector<std::string> serials;
  for (const auto& [id, device] : devices_) serials.push_back(device.serial);
  return fmt::format("device {} (pose.leapc.device) is not attached; attached: {}", wanted_,
                     join(serials, ", "));
}

}  // namespace handcast::pose::leapc
