// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <libusb.h>

#include <string>

#include "ipc/base/result.hpp"

namespace handcast::camera::leap {

/// The endpoint of the images.
inline constexpr unsigned char kImageEndpoint = 0x83;

/// An open device of libusb with a context of its own: a new context sees what is attached now. The
/// last owner gives the interfaces back to the kernel and closes it.
struct UsbHandle {
  UsbHandle() = default;
  ~UsbHandle();
  UsbHandle(const UsbHandle&) = delete;

  libusb_context* context = nullptr;       ///< owned
  libusb_device_handle* device = nullptr;  ///< owned
  std::string port;                        ///< bus and ports: "1-2.3"
};

/// An error of libusb. `doing`: what failed.
Error usb_error(int code, const UsbHandle& handle, std::string_view doing);

}  // namespace handcast::camera::leap
