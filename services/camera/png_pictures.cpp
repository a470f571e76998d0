// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "renderer/media/picture.hpp"
#include "services/camera/played_pictures.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

Result<std::vector<fs::path>> list_pictures(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail(Errc::bad_config, fmt::format("'{}' is not a folder", folder.string()));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  if (files.empty())
    return fail(Errc::bad_config, fmt::format("there is no PNG image in '{}'", folder.string()));
  std::sort(files.begin(), files.end());
  return files;
}

Result<renderer::Image<std::uint8_t>> read_picture(const fs::path& file, int width_px,
                                                   int height_px) {
  auto grey = renderer::read_grey_png(file);
  if (!grey) return grey;
  if (grey->width() != width_px || grey->height() != height_px)
    return fail(Errc::bad_config,
                fmt::format("'{}' is {} x {} px, but the calibration is for a camera of {} x {} px",
                            file.string(), grey->width(), grey->height(), width_px, height_px));
  return grey;
}

/// Decodes all images.
Result<std::vector<renderer::Image<std::uint8_t>>> read_pictures(const fs::path& folder,
                                                                 int width_px, int height_px) {
  const auto files = list_pictures(folder);
  if (!files) return tl::make_unexpected(files.error());
  if (files->size() * width_px * height_px > kMostBytes)
    return fail(
        Errc::bad_config,
        fmt::format("'{}' has {} images, which take more than 1 GiB of memory; replay fewer, or a "
                    "recording of `handcast record`, which is read from the disk",
                    folder.string(), files->size()));
  std::vector<renderer::Image<std::uint8_t>> images;
  for (const auto& file : *files) {
    auto image = read_picture(file, width_px, height_px);
    if (!image) return tl::make_unexpected(image.error());
    images.push_back(std::move(*image));
  }
  return images;
}

class PngPictures final : public PictureSource {
 public:
  PngPictures(std::vector<renderer::Image<std::uint8_t>> images, std::int64_t exposure_ns)
      : images_(std::move(images)), exposure_ns_(exposure_ns) {}
  Result<void> read(std::size_t index, msg::CameraFrame& frame,
                    std::span<std::uint8_t> pixels) override {
    frame = {};
    frame.exposure_ns = exposure_ns_;
    std::ranges::copy(images_[index].pixels(), pixels.begin());
    return {};
  }

 private:
  std::vector<renderer::Image<std::uint8_t>> images_;
  std::int64_t exposure_ns_;
};

}  // namespace

Result<std::vector<std::int64_t>> picture_times_ns(const fs::path& folder, std::size_t count,
                                                   double rate_hz, std::int64_t first_ns) {
  const fs::path file = folder / "camera_timestamps.npy";
  const auto there = recording::is_there(file);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) {
    std::vector<std::int64_t> times_ns;
    for (std::size_t i = 0; i < count; ++i)
      times_ns.push_back(first_ns + seconds_to_ns(static_cast<double>(i) / rate_hz));
    return times_ns;
  }
  auto times_ns = recording::read_stamps_ns(file);
  if (times_ns && times_ns->size() != count)
    return fail(Errc::bad_config, fmt::format("'{}' has {} times for {} images", file.string(),
                                              times_ns->size(), count));
  return times_ns;
}

Result<PlayedPictures> open_png_pictures(const fs::path& folder, const PlayedAs& as) {
  const fs::path inner = folder / "camera";
  const auto has_inner = recording::is_there(inner);
  if (!has_inner) return tl::make_unexpected(has_inner.error());
  auto images = read_pictures(*has_inner ? inner : folder, as.width_px, as.height_px);
  if (!images) return tl::make_unexpected(images.error());
  const auto stamps_ns = recording::read_all_stamps_ns(folder);
  if (!stamps_ns) return tl::make_unexpected(stamps_ns.error());
  const auto lap = timing::Lap::of(*stamps_ns);
  const auto count = images->size();
  auto times_ns = picture_times_ns(folder, count, as.rate_hz, lap.first_ns);
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  auto loop = timing::Loop::make(std::move(*times_ns), lap, as.epoch_ns, as.loop,
                                 seconds_to_ns(1 / as.rate_hz));
  if (!loop) return fail_in("camera_timestamps.npy", loop.error());
  return PlayedPictures{std::make_unique<PngPictures>(std::move(*images), as.exposure_ns),
                        recording::Schedule(std::move(*loop), count)};
}

}  // namespace handcast::camera
