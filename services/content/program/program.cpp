// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/ring/reader.hpp"
#include "services/content/scaled.hpp"
#include "services/content/source.hpp"

namespace handcast::content {
namespace {

/// Multiplies the colours by alpha, or limits them to it: colours above it are noise.
std::uint32_t premultiplied(std::uint32_t pixel, bool is_straight) {
  const std::uint32_t alpha = pixel >> 24;
  std::uint32_t texel = alpha << 24;
  for (int shift = 0; shift < 24; shift += 8) {
    const std::uint32_t level = pixel >> shift & 0xff;
    texel |= (is_straight ? (level * alpha + 127) / 255 : std::min(level, alpha)) << shift;
  }
  return texel;
}

/// The pictures of a program that is not part of the rig. The ring is only looked at, so any number
/// of sources may read it, and a program that writes noise, stops or dies leaves the last picture.
class ProgramSource final : public Source {
 public:
  ProgramSource(ipc::Reader<msg::GuestPicture> reader, std::string stream)
      : reader_(std::move(reader)), stream_(std::move(stream)) {}

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    if (reader_.await(Deadline::now())) {
      const auto newest = reader_.latest(Deadline::now());
      if (!newest && newest.error().code != Errc::timeout)
        return tl::make_unexpected(newest.error());
      if (newest) return take(**newest, moment.time_s, out);
    }
    const bool is_over = moment.time_s > until_s_;
    if (!is_over && moment.frame > 0) return false;
    until_s_ = kForever;
    std::ranges::fill(out.pixels(), 0u);
    return true;
  }

 private:
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  Result<bool> take(const msg::GuestPicture& picture, double time_s, renderer::Texture& out) {
    constexpr auto kLargest_px = msg::GuestPicture::kLargest_px;
    const auto width = picture.width_px, height = picture.height_px;
    if (width == 0 || height == 0 || width > kLargest_px || height > kLargest_px)
      return fail(Errc::bad_data,
                  fmt::format("{}: a picture of {}x{} px was left out; it may have 1x1 to {}x{}",
                              stream_, width, height, kLargest_px, kLargest_px));
    renderer::Texture whole(static_cast<int>(width), static_cast<int>(height));
    std::ranges::transform(
        picture.pixels(), picture.pixels() + whole.pixels().size(), whole.pixels().begin(),
        [&](std::uint32_t pixel) { return premultiplied(pixel, picture.is_straight != 0); });
    out = whole.width() == out.width() && whole.height() == out.height()
              ? std::move(whole)
              : scaled(whole.view(), out.width(), out.height());
    const auto now = now_ns();
    const auto age_ns = now - std::clamp<std::int64_t>(picture.header.published_ns, 0, now);
    until_s_ = picture.lasts_ns > 0 ? time_s + ns_to_seconds(picture.lasts_ns - age_ns) : kForever;
    return true;
  }

  ipc::Reader<msg::GuestPicture> reader_;
  std::string stream_;
  double until_s_ = kForever;  ///< when the picture ends
};

}  // namespace

/// `what`: "left" or "right", whose pictures are shown; "": those for the hand itself.
Result<std::unique_ptr<Source>> open_program(const Opening& opening) {
  const auto& what = opening.element.what;
  if (!what.empty() && what != "left" && what != "right")
    return fail(Errc::bad_config,
                fmt::format("program:{} is not known; write program:left or program:right for the "
                            "pictures of one hand, program: for those of the same hand",
                            quote(what)));
  if (!opening.ring)
    return fail(Errc::unavailable, "other programs show pictures only on a rig that is up");
  const bool is_right = what.empty() ? opening.side == Side::right : what == "right";
  const std::string stream(msg::kGuestPictures[is_right ? 1 : 0]);
  auto segment = opening.ring(stream);
  if (!segment) return tl::make_unexpected(segment.error());
  auto reader = ipc::Reader<msg::GuestPicture>::watch(std::move(*segment));
  if (!reader) return tl::make_unexpected(reader.error());
  return std::make_unique<ProgramSource>(std::move(*reader), stream);
}

}  // namespace handcast::content
