// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/sizes.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>

#include "ipc/base/join.hpp"
#include "services/camera/v4l2/device.hpp"
#include "services/camera/v4l2/format.hpp"

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

}  // namespace handcast::camera::v4l2
