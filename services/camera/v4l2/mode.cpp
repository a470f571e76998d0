// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/mode.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>

#include "ipc/base/join.hpp"

namespace handcast::camera::v4l2 {
namespace {

constexpr std::uint32_t kMostEntries = 1000;  // ends the list of a driver that has no end

int to_px(std::uint32_t side) { return static_cast<int>(std::min<std::uint32_t>(side, 1u << 20)); }

/// Frames per second at an interval of `period` seconds; 0 if it is none.
double rate_of(const v4l2_fract& period) {
  return period.numerator == 0 ? 0 : static_cast<double>(period.denominator) / period.numerator;
}

Sizes sizes_in(const v4l2_frmsizeenum& entry) {
  if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
    const Size size{to_px(entry.discrete.width), to_px(entry.discrete.height)};
    return {.least = size, .most = size};
  }
  const auto& range = entry.stepwise;
  const bool has_steps = entry.type == V4L2_FRMSIZE_TYPE_STEPWISE;
  return {.least = {to_px(range.min_width), to_px(range.min_height)},
          .most = {to_px(range.max_width), to_px(range.max_height)},
          .step = {has_steps ? std::max(1, to_px(range.step_width)) : 1,
                   has_steps ? std::max(1, to_px(range.step_height)) : 1}};
}

std::vector<Sizes> sizes_of(int fd, std::uint32_t code) {
  std::vector<Sizes> sizes;
  for (v4l2_frmsizeenum entry{.index = 0, .pixel_format = code};
       entry.index < kMostEntries && call(fd, VIDIOC_ENUM_FRAMESIZES, &entry) == 0; ++entry.index) {
    sizes.push_back(sizes_in(entry));
    sizes.back().rate_hz = highest_rate_hz(fd, code, sizes.back().most);
    if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;  // a range is the only entry
  }
  return sizes;
}

}  // namespace

bool Sizes::contains(Size size) const {
  const auto fits = [](int value, int low, int high, int step_px) {
    return value >= low && value <= high && (value - low) % step_px == 0;
  };
  return fits(size.width_px, least.width_px, most.width_px, step.width_px) &&
         fits(size.height_px, least.height_px, most.height_px, step.height_px);
}

double highest_rate_hz(int fd, std::uint32_t code, Size size) {
  double rate_hz = 0;
  for (v4l2_frmivalenum entry{.index = 0,
                        .pixel_format = code,
                        .width = static_cast<__u32>(size.width_px),
                        .height = static_cast<__u32>(size.height_px)};
       entry.index < kMostEntries && call(fd, VIDIOC_ENUM_FRAMEINTERVALS, &entry) == 0;
       ++entry.index) {
    if (entry.type != V4L2_FRMIVAL_TYPE_DISCRETE) return rate_of(entry.stepwise.min);
    rate_hz = std::max(rate_hz, rate_of(entry.discrete));
  }
  return rate_hz;
}

std::vector<FormatSizes> formats_of(int fd) {
  std::vector<FormatSizes> formats;
  for (v4l2_fmtdesc entry{.index = 0, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
       entry.index < kMostEntries && call(fd, VIDIOC_ENUM_FMT, &entry) == 0; ++entry.index) {
    const auto format = format_of(entry.pixelformat);
    formats.push_back({.code = entry.pixelformat,
                       .name = format ? std::string(word_of(*format)) : text_of(entry.pixelformat),
                       .is_readable = format.has_value(),
                       .sizes = sizes_of(fd, entry.pixelformat)});
  }
  return formats;
}

std::string describe(const Sizes& sizes) {
  const auto text = [](Size size) { return fmt::format("{}x{}", size.width_px, size.height_px); };
  const auto rate = sizes.rate_hz > 0 ? fmt::format(" at {:.3g} Hz", sizes.rate_hz) : "";
  if (sizes.least == sizes.most) return text(sizes.least) + rate;
  return fmt::format("{} to {}{}", text(sizes.least), text(sizes.most), rate);
}

std::string describe(std::span<const FormatSizes> formats) {
  std::vector<std::string> texts;
  for (const auto& format : formats) {
    std::vector<std::string> sizes;
    for (const auto& one : format.sizes) sizes.push_back(describe(one));
    texts.push_back(format.name + (sizes.empty() ? "" : " in " + join(sizes, ", ")));
  }
  return texts.empty() ? "none" : join(texts, "; ");
}

namespace {

using config::WebcamFormat;

v4l2_format request_of(WebcamFormat format, Size size) {
  v4l2_format request{};
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.fmt.pix.width = static_cast<__u32>(size.width_px);
  request.fmt.pix.height = static_cast<__u32>(size.height_px);
  request.fmt.pix.pixelformat = code_of(format);
  request.fmt.pix.field = V4L2_FIELD_NONE;
  return request;
}

/// Drivers change what they cannot do and report success.
bool is_granted(const v4l2_format& answer, WebcamFormat format, Size size) {
  const auto& pix = answer.fmt.pix;
  return pix.pixelformat == code_of(format) &&
         Size{static_cast<int>(pix.width), static_cast<int>(pix.height)} == size;
}

bool is_listed(int fd, WebcamFormat format, Size size) {
  return std::ranges::any_of(formats_of(fd), [&](const FormatSizes& listed) {
    return listed.code == code_of(format) &&
           std::ranges::any_of(listed.sizes, [&](const auto& one) { return one.contains(size); });
  });
}

/// Whether the camera has this format and size, without setting them.
bool has(int fd, WebcamFormat format, Size size) {
  auto request = request_of(format, size);
  const int number = call(fd, VIDIOC_TRY_FMT, &request);
  if (number == ENOTTY) return is_listed(fd, format, size);  // some drivers cannot be asked
  return number == 0 && is_granted(request, format, size);
}

std::optional<WebcamFormat> choose(int fd, WebcamFormat wanted, Size size) {
  if (wanted != WebcamFormat::automatic)
    return has(fd, wanted, size) ? std::optional(wanted) : std::nullopt;
  const auto found =
      std::ranges::find_if(kFormats, [&](auto format) { return has(fd, format, size); });
  return found == kFormats.end() ? std::nullopt : std::optional(*found);
}

Error lacks(const Device& device, WebcamFormat wanted, Size size) {
  const auto formats = formats_of(device.fd.get());
  return {Errc::bad_config,
          fmt::format("{} has no {} of {}x{} px, the size in the calibration; it has {}; set "
                      "v4l2.format or calibrate the camera in one of these sizes",
                      describe(device.identity),
                      wanted == WebcamFormat::automatic ? "image that handcast reads"
                                                        : fmt::format("{} image", word_of(wanted)),
                      size.width_px, size.height_px, describe(formats))};
}

/// Bytes from row to row. Some old drivers leave them out.
std::size_t row_bytes(const v4l2_pix_format& pix, WebcamFormat format) {
  const std::size_t least = bytes_per_pixel(format) * pix.width;
  return least == 0 ? 0 : std::max<std::size_t>(pix.bytesperline, least);
}

Result<Layout> set_format(const Device& device, WebcamFormat format, Size size) {
  auto request = request_of(format, size);
  if (const int number = call(device.fd.get(), VIDIOC_S_FMT, &request); number != 0)
    return tl::make_unexpected(
        error_of(device.identity, Errc::bad_config, "the format cannot be set", number));
  if (!is_granted(request, format, size)) return tl::make_unexpected(lacks(device, format, size));
  const auto& pix = request.fmt.pix;
  if (pix.field != V4L2_FIELD_NONE && pix.field != V4L2_FIELD_ANY)
    return fail(Errc::bad_config, fmt::format("{} sends half-images (interlaced), which were "
                                              "exposed at different times; use another camera",
                                              describe(device.identity)));
  return Layout{format, size.width_px, size.height_px, row_bytes(pix, format)};
}

/// Asks for a rate. The rate that the driver holds then; 0 if it does not say.
double set_rate(int fd, double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (call(fd, VIDIOC_G_PARM, &parameters) != 0 ||
      (parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) == 0)
    return 0;
  auto& period = parameters.parm.capture.timeperframe;
  period = {.numerator = 1000, .denominator = static_cast<__u32>(std::lround(rate_hz * 1000))};
  if (call(fd, VIDIOC_S_PARM, &parameters) != 0 && call(fd, VIDIOC_G_PARM, &parameters) != 0)
    return 0;
  return period.numerator == 0 ? 0 : static_cast<double>(period.denominator) / period.numerator;
}

}  // namespace

Result<Mode> set_mode(const Device& device, WebcamFormat format, Size size, double rate_hz) {
  const auto chosen = choose(device.fd.get(), format, size);
  if (!chosen) return tl::make_unexpected(lacks(device, format, size));
  const auto layout = set_format(device, *chosen, size);
  if (!layout) return tl::make_unexpected(layout.error());
  return Mode{*layout, set_rate(device.fd.get(), rate_hz)};
}

}  // namespace handcast::camera::v4l2
