// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "services/projector/dlp/protocol/message.hpp"

namespace handcast::dlp {

/// An attached USB HID device.
struct HidInfo {
  std::string path;     ///< "/dev/hidraw0"
  std::string serial;   ///< may be empty
  std::string product;  ///< as the device calls itself
  std::uint16_t product_id = 0;
};

/// The attached devices of a vendor, without further interfaces of the same device.
std::vector<HidInfo> list_hid_devices(std::uint16_t vendor_id);

/// An open USB HID device that exchanges reports of 64 bytes. The calls of its library have no
/// deadline (the kernel may take 5 s to write a report to a device that has stopped), so they are
/// made on a thread of their own. A device whose call is late is lost: each later call fails. One
/// thread.
class HidDevice {
 public:
  /// Errors: unavailable (it is gone, or access is denied).
  static Result<std::unique_ptr<HidDevice>> open(const HidInfo& info);
  /// Closes the device. If a call is stuck in the kernel, its thread closes it later.
  ~HidDevice();
  HidDevice(const HidDevice&) = delete;

  /// Sends a report. Errors: disconnected (or not sent by the deadline).
  Result<void> write(const protocol::Report& report, Deadline deadline);
  /// Receives a report. Returns the number of its bytes. Errors: timeout, disconnected.
  Result<std::size_t> read(protocol::Report& report, Deadline deadline);

 private:
  struct Port;
  explicit HidDevice(std::shared_ptr<Port> port);
  Result<int> carry_out(int job, protocol::Report& report, Deadline deadline);

  std::shared_ptr<Port> port_;  ///< shared with the thread
  std::thread thread_;
  bool lost_ = false;
};

}  // namespace handcast::dlp
