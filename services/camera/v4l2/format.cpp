// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/format.hpp"

#include <linux/videodev2.h>

namespace handcast::camera::v4l2 {

using config::WebcamFormat;

std::uint32_t code_of(WebcamFormat format) {
  switch (format) {
    case WebcamFormat::grey:
      return V4L2_PIX_FMT_GREY;
    case WebcamFormat::y10:
      return V4L2_PIX_FMT_Y10;
    case WebcamFormat::y16:
      return V4L2_PIX_FMT_Y16;
    case WebcamFormat::yuyv:
      return V4L2_PIX_FMT_YUYV;
    case WebcamFormat::nv12:
      return V4L2_PIX_FMT_NV12;
    case WebcamFormat::mjpeg:
      return V4L2_PIX_FMT_MJPEG;
    case WebcamFormat::automatic:
      break;
  }
  return 0;
}

std::optional<WebcamFormat> format_of(std::uint32_t code) {
  for (const auto format : kFormats)
    if (code_of(format) == code) return format;
  return std::nullopt;
}

std::string text_of(std::uint32_t code) {
  std::string text;
  for (const int shift : {0, 8, 16, 24}) text += static_cast<char>(code >> shift & 0x7f);
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string_view word_of(WebcamFormat format) {
  return words_of(format)[static_cast<std::size_t>(format)];
}

std::size_t bytes_per_pixel(WebcamFormat format) {
  switch (format) {
    case WebcamFormat::y10:
    case WebcamFormat::y16:
    case WebcamFormat::yuyv:
      return 2;
    case WebcamFormat::grey:
    case WebcamFormat::nv12:
      return 1;
    case WebcamFormat::mjpeg:
    case WebcamFormat::automatic:
      break;
  }
  return 0;
}

}  // namespace handcast::camera::v4l2
