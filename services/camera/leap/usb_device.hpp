// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/camera/leap/transfer.hpp"

namespace handcast::camera::leap {

struct UsbHandle;

/// The USB ports with a controller, as bus and ports ("1-2.3"). None is opened.
std::vector<std::string> controller_ports();

/// An open controller, with both of its interfaces taken from the kernel's driver. One thread.
class UsbDevice {
 public:
  /// Errors: unavailable (there is none at this port, another program uses it, or access is
  /// denied).
  static Result<UsbDevice> open(const std::string& port);

  /// Writes; or reads, which may give fewer bytes than asked for. At most 0.5 s. Errors:
  /// disconnected, timeout (no answer), bad_data (the controller refuses it).
  /// @{
  Result<void> write(const ControlTransfer& transfer);
  Result<std::vector<std::uint8_t>> read(const ControlTransfer& transfer);
  /// @}
  /// The class-specific descriptors of the two interfaces. Errors: disconnected.
  Result<StreamDescription> describe() const;
  /// Ends a halt of the endpoint of the images. Errors: disconnected.
  Result<void> clear_halt();
  /// Resets the device at its port. If it comes back as another one, open it again. Errors:
  /// disconnected.
  Result<void> reset();

  /// For UsbStream.
  const std::shared_ptr<UsbHandle>& handle() const { return handle_; }

 private:
  explicit UsbDevice(std::shared_ptr<UsbHandle> handle) : handle_(std::move(handle)) {}
  Result<int> carry_out(const ControlTransfer& transfer, std::uint8_t* data);

  std::shared_ptr<UsbHandle> handle_;
};

}  // namespace handcast::camera::leap
