// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/list.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

namespace handcast::camera::v4l2 {
namespace {

/// Gives back the buffers of this process, of which there are none: the driver refuses even that
/// while another program has buffers.
bool is_busy(int fd) {
  v4l2_requestbuffers none{
      .count = 0, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
  return call(fd, VIDIOC_REQBUFS, &none) == EBUSY;
}

std::string trouble_of(const Device& device, const std::vector<FormatSizes>& formats) {
  if (!device.identity.fault.empty()) return device.identity.fault;
  if (std::ranges::none_of(formats, &FormatSizes::is_readable))
    return "it has no format that handcast reads (GREY, Y16, Y10, NV12, YUYV, MJPEG)";
  if (is_busy(device.fd.get())) return error_of(device.identity, Errc::unavailable, "", EBUSY).what;
  return {};
}

}  // namespace

std::vector<ListedCamera> list_cameras() {
  std::vector<ListedCamera> cameras;
  for (const auto& path : device_paths()) {
    const auto device = open_device(path);
    if (!device) {
      cameras.emplace_back();
      cameras.back().identity.path = path;
      cameras.back().trouble = device.error().what;
    } else if (device->identity.films) {
      auto formats = formats_of(device->fd.get());
      auto trouble = trouble_of(*device, formats);
      cameras.push_back({device->identity, std::move(formats), std::move(trouble)});
    }
  }
  return cameras;
}

}  // namespace handcast::camera::v4l2
