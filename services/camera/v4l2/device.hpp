// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::camera::v4l2 {

/// A video device as its driver describes it.
struct Identity {
  std::string path;    ///< e.g. "/dev/video0"
  std::string card;    ///< the name of the camera, e.g. "HD Pro Webcam C920"
  std::string bus;     ///< where it is plugged in, e.g. "usb-0000:00:14.0-1"
  bool films = false;  ///< it captures images; other devices deliver metadata, or play
  std::string fault;   ///< why its images cannot be used; empty if they can
};

/// An open video device. It does not block.
struct Device {
  UniqueFd fd;
  Identity identity;
};

/// Calls ioctl(), again if a signal interrupted it. 0, or the errno.
int call(int fd, unsigned long request, void* argument);

/// An error of a device: unavailable if another program uses it, disconnected if it is gone,
/// otherwise `code`.
Error error_of(const Identity& identity, Errc code, std::string_view what, int number);

/// Opens a video device and asks for its identity. Errors: bad_config (no permission; the sentence
/// names the group that has it), unavailable (there is no such device, or it is in use).
Result<Device> open_device(const std::string& path);

/// The paths /dev/videoN that exist.
std::vector<std::string> device_paths();

/// Opens the camera that is meant by `wanted`: a path, or a name or bus. Empty: the only one that
/// captures. Errors: those of open_device(); with a list of the cameras: bad_config (several fit),
/// unavailable (none does; it may be plugged in later); bad_config (Identity::fault).
Result<Device> find_device(const std::string& wanted);

/// E.g. "'HD Pro Webcam C920' (/dev/video0, usb-0000:00:14.0-1)".
std::string describe(const Identity& identity);

}  // namespace handcast::camera::v4l2
