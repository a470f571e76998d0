// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/descriptors.hpp"

#include <fmt/format.h>

#include <string>

#include "services/camera/leap/little_endian.hpp"

namespace handcast::camera::leap {
namespace {

constexpr std::uint8_t kClassInterface = 0x24;
/// Subtypes. The numbers of the two interfaces overlap.
constexpr std::uint8_t kControlHeader = 0x01, kFormatUncompressed = 0x04, kFrameUncompressed = 0x05;
constexpr std::size_t kLeastHeader = 12, kLeastFormat = 22, kLeastFrame = 26;
constexpr int kLargest_px = 4096;
constexpr double kTicksPerSecond = 1e7;
constexpr double kFastEnough = 0.99;
/// From 1 Hz to 10 kHz.
constexpr std::uint32_t kShortestTicks = 1'000, kLongestTicks = 10'000'000;
constexpr std::uint8_t kBitsPerPixel = 16;

/// Calls `use` with each descriptor. Errors: bad_data (the last one is cut off).
template <class Use>
Result<void> for_each(std::span<const std::uint8_t> bytes, const Use& use) {
  while (!bytes.empty()) {
    const std::size_t length = bytes[0];
    if (length < 3 || length > bytes.size())
      return fail(Errc::bad_data, fmt::format("a descriptor of {} bytes, of which {} are there",
                                              length, bytes.size()));
    if (bytes[1] == kClassInterface) use(bytes[2], bytes.first(length));
    bytes = bytes.subspan(length);
  }
  return {};
}

void add_mode(std::span<const std::uint8_t> frame, std::uint8_t format,
              std::vector<StreamMode>& modes) {
  StreamMode mode;
  mode.format = format;
  mode.frame = frame[3];
  mode.width_px = get_16(frame, 5);
  mode.height_px = get_16(frame, 7);
  mode.ticks = get_32(frame, 21);
  if (mode.width_px == 0 || mode.width_px > kLargest_px || mode.height_px == 0 ||
      mode.height_px > kLargest_px || mode.ticks < kShortestTicks || mode.ticks > kLongestTicks)
    return;
  mode.rate_hz = kTicksPerSecond / mode.ticks;
  modes.push_back(mode);
}

}  // namespace

Result<StreamDescription> parse_descriptors(std::span<const std::uint8_t> control,
                                            std::span<const std::uint8_t> streaming) {
  StreamDescription description;
  auto read = for_each(control, [&](std::uint8_t subtype, std::span<const std::uint8_t> bytes) {
    if (subtype == kControlHeader && bytes.size() >= kLeastHeader)
      description.clock_hz = get_32(bytes, 7);
  });
  if (!read) return fail_in("video control", read.error());
  std::uint8_t format = 0;  // 0: one that is not read
  read = for_each(streaming, [&](std::uint8_t subtype, std::span<const std::uint8_t> bytes) {
    if (subtype == kFormatUncompressed && bytes.size() >= kLeastFormat)
      format = bytes[21] == kBitsPerPixel ? bytes[3] : std::uint8_t{0};
    if (subtype == kFrameUncompressed && bytes.size() >= kLeastFrame && format != 0)
      add_mode(bytes, format, description.modes);
  });
  if (!read) return fail_in("video streaming", read.error());
  if (description.modes.empty())
    return fail(Errc::bad_data, "the device describes no images with two bytes per pixel");
  return description;
}

Result<StreamMode> mode_of(const StreamDescription& description, int width_px, int height_px,
                           double rate_hz) {
  const auto find = [&](int rows) -> const StreamMode* {
    for (const auto& mode : description.modes)
      if (mode.width_px == width_px && mode.height_px == rows) return &mode;
    return nullptr;
  };
  for (const int part : {1, 2, 4}) {
    const auto* mode = height_px % part == 0 ? find(height_px / part) : nullptr;
    if (mode && mode->rate_hz > kFastEnough * rate_hz) return *mode;
  }
  if (const auto* half = height_px % 2 == 0 ? find(height_px / 2) : nullptr) return *half;
  if (const auto* whole = find(height_px)) return *whole;
  std::string sizes;
  for (const auto& mode : description.modes)
    sizes += fmt::format("{}{}x{} at {:.4g} Hz", sizes.empty() ? "" : ", ", mode.width_px,
                         mode.height_px, mode.rate_hz);
  return fail(Errc::bad_config,
              fmt::format("the calibration is for images of {}x{} px; the controller has {}",
                          width_px, height_px, sizes));
}

}  // namespace handcast::camera::leap
