// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "ipc/base/clock.hpp"
#include "services/camera/played_pictures.hpp"
#include "services/recording/arrays/npy.hpp"

namespace handcast::camera {
namespace {

class NpyPictures final : public PictureSource {
 public:
  NpyPictures(recording::NpyBytes file, std::int64_t exposure_ns)
      : file_(std::move(file)), exposure_ns_(exposure_ns) {}

  Result<void> read(std::size_t index, msg::CameraFrame& frame,
                    std::span<std::uint8_t> pixels) override {
    frame = {};
    frame.exposure_ns = exposure_ns_;
    auto offset = static_cast<off_t>(file_.data_offset + index * pixels.size());
    while (!pixels.empty()) {
      const auto got = ::pread(file_.fd.get(), pixels.data(), pixels.size(), offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0)
        return fail(Errc::bad_data, fmt::format("image {} of the array cannot be read", index));
      pixels = pixels.subspan(static_cast<std::size_t>(got));
      offset += got;
    }
    return {};
  }

 private:
  recording::NpyBytes file_;
  std::int64_t exposure_ns_;
};

bool is_of_size(const std::vector<std::size_t>& shape, const PlayedAs& as) {
  return shape.size() == 3 && std::cmp_equal(shape[1], as.height_px) &&
         std::cmp_equal(shape[2], as.width_px);
}

}  // namespace

Result<PlayedPictures> open_npy_pictures(const std::filesystem::path& file, const PlayedAs& as) {
  auto array = recording::open_npy_bytes(file);
  if (!array) return tl::make_unexpected(array.error());
  if (!is_of_size(array->shape, as))
    return fail(
        Errc::bad_config,
        fmt::format("'{}' has the shape ({}); the calibration is for images of (n, {}, {})",
                    file.string(), fmt::join(array->shape, ", "), as.height_px, as.width_px));
  const auto count = array->shape[0];
  constexpr std::size_t kMostImages = 20'000'000;
  if (count > kMostImages)
    return fail(Errc::bad_config,
                fmt::format("'{}' has more than {} images", file.string(), kMostImages));
  auto times_ns = picture_times_ns(file.parent_path(), count, as.rate_hz, 0);
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  auto loop = timing::Loop::make(std::move(*times_ns), {}, as.epoch_ns, as.loop,
                                 seconds_to_ns(1 / as.rate_hz));
  if (!loop) return fail_in(file.string(), loop.error());
  return PlayedPictures{std::make_unique<NpyPictures>(std::move(*array), as.exposure_ns),
                        recording::Schedule(std::move(*loop), count)};
}

}  // namespace handcast::camera
