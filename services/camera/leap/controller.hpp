// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/camera/leap/calibration_block.hpp"
#include "services/camera/leap/usb_device.hpp"

namespace handcast::camera::leap {

/// A controller that is open, with its names.
struct Controller {
  UsbDevice device;    ///< the open device
  std::string port;    ///< "1-2.3"
  std::string serial;  ///< "LP12345678901"; empty if it does not say
};

/// Opens the controller that `wanted` means: its serial number or USB port; empty: the only one.
/// To read a serial number, a controller must be opened: those that are in use are passed over.
/// Errors: those of UsbDevice::open(); unavailable (none fits), bad_config (several do). The
/// sentence lists those that are there.
Result<Controller> open_controller(const std::string& wanted);

/// Reads `count` bytes of a controller's memory, from an address. Takes 4 ms for each. Errors:
/// those of UsbDevice::read().
Result<std::vector<std::uint8_t>> read_memory(UsbDevice& device, int address, std::size_t count);

/// Reads the calibration that a controller was given by its maker, in 0.7 s. Errors: those of
/// read_memory() and parse_calibration().
Result<ControllerCalibration> read_calibration(UsbDevice& device);

/// Reads the calibration of a controller and makes a calibration file of its left or right eye, for
/// images of a size; see calibration_file_of(). `wanted`: camera.leap.device. Opens the controller
/// for about a second. Errors: those of open_controller(), read_calibration() and
/// calibration_file_of().
Result<std::string> calibration_file_from(const std::string& wanted, bool of_right_eye,
                                          int width_px, int height_px);

}  // namespace handcast::camera::leap
