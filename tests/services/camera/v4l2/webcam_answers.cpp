// SPDX-License-Identifier: Apache-2.0
// What the emulated camera answers about itself, its formats and rates.
#include <fcntl.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "tests/services/camera/v4l2/webcam_kernel.hpp"

namespace handcast::test {
namespace {

template <class T>
T& in(void* argument) {
  return *static_cast<T*>(argument);
}

template <std::size_t size>
void put(const std::string& text, __u8 (&to)[size]) {
  std::memcpy(to, text.data(), std::min(text.size(), size - 1));
}

std::uint32_t row_bytes(const EmulatedFormat& format, std::uint32_t width) {
  switch (format.code) {
    case V4L2_PIX_FMT_MJPEG:
      return 0;
    case V4L2_PIX_FMT_GREY:
    case V4L2_PIX_FMT_NV12:
      return width + format.padding;
    default:
      return 2 * width + format.padding;
  }
}

std::uint32_t image_bytes(const EmulatedFormat& format, std::uint32_t width, std::uint32_t height) {
  if (format.code == V4L2_PIX_FMT_MJPEG) return 2 * width * height;
  const auto plane = row_bytes(format, width) * height;
  return format.code == V4L2_PIX_FMT_NV12 ? plane + row_bytes(format, width) * ((height + 1) / 2)
                                          : plane;
}

}  // namespace

bool EmulatedWebcam::Kernel::is_at(std::string_view path) const {
  const std::lock_guard lock(mutex_);
  return is_plugged_ && path == description_.path;
}

int EmulatedWebcam::Kernel::stat(struct stat& file) const {
  EmulatedDevice::stat(file);
  const std::lock_guard lock(mutex_);
  if (faults_.has_no_group) file.st_mode = S_IFCHR | S_IRUSR | S_IWUSR;
  return 0;
}

int EmulatedWebcam::Kernel::open() {
  const std::lock_guard lock(mutex_);
  if (faults_.open_fails != 0) return -faults_.open_fails;
  const int fd = eventfd(0, EFD_CLOEXEC);  // only its number is used
  if (fd < 0) return -errno;
  files_.insert(fd);
  return fd;
}

bool EmulatedWebcam::Kernel::owns(int fd) const {
  const std::lock_guard lock(mutex_);
  return files_.contains(fd);
}

void EmulatedWebcam::Kernel::close(int fd) {
  const std::lock_guard lock(mutex_);
  files_.erase(fd);
  gone_.erase(fd);
  if (owner_ == fd) release();
}

int EmulatedWebcam::Kernel::ioctl(int fd, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  if (gone_.contains(fd)) return -ENODEV;
  switch (request) {
    case VIDIOC_S_FMT:
      return set_format(fd, in<v4l2_format>(argument));
    case VIDIOC_REQBUFS:
      return this->request(fd, in<v4l2_requestbuffers>(argument));
    case VIDIOC_QUERYBUF:
      return query(in<v4l2_buffer>(argument));
    case VIDIOC_QBUF:
      return queue(fd, in<v4l2_buffer>(argument));
    case VIDIOC_DQBUF:
      return dequeue(fd, in<v4l2_buffer>(argument));
    case VIDIOC_STREAMON:
      return start(fd, in<int>(argument));
    case VIDIOC_STREAMOFF:
      return stop(fd, in<int>(argument));
    default:
      return answer(request, argument);
  }
}

int EmulatedWebcam::Kernel::answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return query(in<v4l2_capability>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerate(in<v4l2_fmtdesc>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate(in<v4l2_frmsizeenum>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate(in<v4l2_frmivalenum>(argument));
    case VIDIOC_TRY_FMT:
      return try_format(in<v4l2_format>(argument));
    case VIDIOC_G_PARM:
      return get_rate(in<v4l2_streamparm>(argument));
    case VIDIOC_S_PARM:
      return set_rate(in<v4l2_streamparm>(argument));
    case VIDIOC_QUERY_EXT_CTRL:
      return query(in<v4l2_query_ext_ctrl>(argument));
    case VIDIOC_QUERYMENU:
      return query(in<v4l2_querymenu>(argument));
    case VIDIOC_G_EXT_CTRLS:
      return transfer(in<v4l2_ext_controls>(argument), false);
    case VIDIOC_S_EXT_CTRLS:
      return transfer(in<v4l2_ext_controls>(argument), true);
    default:
      return -ENOTTY;
  }
}

int EmulatedWebcam::Kernel::query(v4l2_capability& capability) const {
  capability = {};
  put("emulated", capability.driver);
  put(description_.card, capability.card);
  put(description_.bus, capability.bus_info);
  capability.device_caps = description_.capabilities;
  // Those of all devices of the driver: a webcam's other device delivers metadata.
  capability.capabilities = description_.capabilities | V4L2_CAP_VIDEO_CAPTURE |
                            V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_DEVICE_CAPS;
  return 0;
}

int EmulatedWebcam::Kernel::enumerate(v4l2_fmtdesc& entry) const {
  if (entry.type != V4L2_BUF_TYPE_VIDEO_CAPTURE || entry.index >= description_.formats.size())
    return -EINVAL;
  entry.pixelformat = description_.formats[entry.index].code;
  return 0;
}

const EmulatedFormat* EmulatedWebcam::Kernel::format_of(std::uint32_t code) const {
  const auto found = std::ranges::find(description_.formats, code, &EmulatedFormat::code);
  return found == description_.formats.end() ? nullptr : &*found;
}

int EmulatedWebcam::Kernel::enumerate(v4l2_frmsizeenum& entry) const {
  const auto* format = format_of(entry.pixel_format);
  if (format == nullptr || entry.index >= format->sizes.size()) return -EINVAL;
  entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  entry.discrete = {format->sizes[entry.index].width, format->sizes[entry.index].height};
  return 0;
}

const EmulatedFormat::Size* EmulatedWebcam::Kernel::size_of(std::uint32_t code, std::uint32_t width,
                                                            std::uint32_t height) const {
  const auto* format = format_of(code);
  if (format == nullptr) return nullptr;
  const auto found = std::ranges::find_if(format->sizes, [&](const auto& size) {
    return size.width == width && size.height == height;
  });
  return found == format->sizes.end() ? nullptr : &*found;
}

int EmulatedWebcam::Kernel::enumerate(v4l2_frmivalenum& entry) const {
  const auto* size = size_of(entry.pixel_format, entry.width, entry.height);
  if (size == nullptr || entry.index >= size->rates_hz.size()) return -EINVAL;
  entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  entry.discrete = {1, size->rates_hz[entry.index]};
  return 0;
}

/// Takes the first format and the nearest size if the camera lacks those that are wanted.
int EmulatedWebcam::Kernel::try_format(v4l2_format& format) const {
  if (format.type != V4L2_BUF_TYPE_VIDEO_CAPTURE) return -EINVAL;
  auto& pix = format.fmt.pix;
  const auto* found = format_of(pix.pixelformat);
  if (found == nullptr) found = &description_.formats.front();
  const auto apart = [&](const EmulatedFormat::Size& size) {
    return std::abs(double{static_cast<double>(size.width)} - pix.width) +
           std::abs(double{static_cast<double>(size.height)} - pix.height);
  };
  const auto& size = *std::ranges::min_element(found->sizes, {}, apart);
  pix = {.width = size.width,
         .height = size.height,
         .pixelformat = found->code,
         .field = description_.field,
         .bytesperline = row_bytes(*found, size.width),
         .sizeimage = image_bytes(*found, size.width, size.height),
         .colorspace = V4L2_COLORSPACE_SRGB};
  return 0;
}

int EmulatedWebcam::Kernel::set_format(int fd, v4l2_format& format) {
  if (is_of_another(fd) || !buffers_.empty()) return -EBUSY;
  if (const int answer = try_format(format); answer != 0) return answer;
  format_ = format.fmt.pix;
  rate_hz_ = size_of(format_.pixelformat, format_.width, format_.height)->rates_hz.front();
  return 0;
}

int EmulatedWebcam::Kernel::get_rate(v4l2_streamparm& parameters) const {
  if (parameters.type != V4L2_BUF_TYPE_VIDEO_CAPTURE) return -EINVAL;
  parameters.parm.capture = {};
  if (!description_.says_its_rate) return 0;
  parameters.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
  parameters.parm.capture.timeperframe = {1, rate_hz_};
  return 0;
}

int EmulatedWebcam::Kernel::set_rate(v4l2_streamparm& parameters) {
  if (parameters.type != V4L2_BUF_TYPE_VIDEO_CAPTURE) return -EINVAL;
  if (streams_) return -EBUSY;
  const auto& wanted = parameters.parm.capture.timeperframe;
  if (wanted.numerator == 0) return -EINVAL;
  const double rate_hz = double{static_cast<double>(wanted.denominator)} / wanted.numerator;
  const auto* size = size_of(format_.pixelformat, format_.width, format_.height);
  if (size == nullptr) return -EINVAL;
  rate_hz_ = *std::ranges::min_element(
      size->rates_hz, {}, [&](std::uint32_t rate) { return std::abs(rate - rate_hz); });
  return get_rate(parameters);
}

}  // namespace handcast::test
