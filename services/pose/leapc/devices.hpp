// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "services/pose/leapc/declarations.hpp"

namespace handcast::pose::leapc {

/// The devices that the service has announced on one connection. One thread.
class Devices {
 public:
  /// `wanted`: the serial number of the device whose frames are asked for; empty: the service
  /// chooses. `call` must outlive it.
  Devices(const Functions& call, std::string wanted) : call_(call), wanted_(std::move(wanted)) {}
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;
  ~Devices() { clear(); }

  /// A device was attached: its serial number is read and logged; a wanted one is subscribed to.
  void attached(ConnectionHandle connection, const DeviceEvent& event);
  /// A device is gone.
  void lost(const DeviceEvent& event);
  /// The connection is gone, and all devices with it.
  void clear();

  /// Whether frames of this device, 0 if the message does not say, are to be used.
  bool is_wanted(std::uint32_t id) const;
  /// Why no frames can come; empty if they can.
  std::string trouble() const;

 private:
  struct Device {
    DeviceHandle handle = nullptr;  ///< open if it is subscribed to
    std::string serial;
  };

  std::string serial_of(DeviceHandle device) const;
  bool is_wanted(const Device& device) const { return wanted_.empty() || device.serial == wanted_; }

  const Functions& call_;
  std::string wanted_;
  std::map<std::uint32_t, Device> devices_;  ///< by the service's id
};

}  // namespace handcast::pose::leapc
