// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/camera/played_pictures.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

/// Compares names with their numbers as numbers: "2.png" before "10.png".
bool comes_before(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto number_of = [&](std::string_view text) {
    const auto end = std::ranges::find_if_not(text, is_digit);
    return text.substr(0, static_cast<std::size_t>(end - text.begin()));
  };
  const auto value_of = [](std::string_view digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
  };
  const auto whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    const auto digits_a = number_of(a), digits_b = number_of(b);
    const auto value_a = value_of(digits_a), value_b = value_of(digits_b);
    if (digits_a.empty() || digits_b.empty()) {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1), b.remove_prefix(1);
      continue;
    }
    if (value_a.size() != value_b.size()) return value_a.size() < value_b.size();
    if (value_a != value_b) return value_a < value_b;
    a.remove_prefix(digits_a.size()), b.remove_prefix(digits_b.size());
  }
  return a.empty() != b.empty() ? a.empty() : whole_a < whole_b;
}

bool is_picture(const fs::path& file) {
  auto ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".png" && !file.filename().string().starts_with('.');  // "._1.png" of macOS
}

Result<std::vector<fs::path>> list_pictures(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail(Errc::bad_config, fmt::format("'{}' is not a folder", folder.string()));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_picture(entry.path())) files.push_back(entry.path());
  if (files.empty())
    return fail(Errc::bad_config, fmt::format("there is no PNG image in '{}'", folder.string()));
  std::ranges::sort(files, comes_before, [](const fs::path& file) { return file.string(); });
  return files;
}

struct Pictures {
  std::vector<renderer::Image<std::uint8_t>> images;
  std::uint32_t largest = 0;  ///< GreyPicture::largest of all of them
};

/// Decodes all images.
Result<Pictures> read_pictures(const std::vector<fs::path>& files, const PlayedAs& as,
                               int used_bits) {
  Pictures pictures;
  for (const auto& file : files) {
    auto read = renderer::read_camera_picture(file, used_bits);
    if (!read) return tl::make_unexpected(read.error());
    if (read->grey.width() != as.width_px || read->grey.height() != as.height_px)
      return fail(
          Errc::bad_config,
          fmt::format("'{}' is {} x {} px, but the calibration is for a camera of {} x {} px",
                      file.string(), read->grey.width(), read->grey.height(), as.width_px,
                      as.height_px));
    pictures.images.push_back(std::move(read->grey));
    pictures.largest = std::max(pictures.largest, read->largest);
  }
  return pictures;
}

/// The same, with the bits that the camera has used: many have 12 and save 16.
Result<Pictures> read_pictures(const fs::path& folder, const PlayedAs& as) {
  const auto files = list_pictures(folder);
  if (!files) return tl::make_unexpected(files.error());
  if (files->size() * as.width_px * as.height_px > kMostBytes)
    return fail(
        Errc::bad_config,
        fmt::format("'{}' has {} images, which take more than 1 GiB of memory; replay fewer, or a "
                    "recording of `handcast record`, which is read from the disk",
                    folder.string(), files->size()));
  constexpr int kAll = 16, kMaybe = 14;
  auto pictures = read_pictures(*files, as, kAll);
  if (!pictures) return pictures;
  const auto largest = pictures->largest;
  if (const int used_bits = renderer::used_bits_of(largest); used_bits < kAll) {
    log::info("the largest of the 16-bit values in '{}' is {}: they are read as values of {} bits",
              folder.string(), largest, used_bits);
    return read_pictures(*files, as, used_bits);
  }
  if (largest > 0 && largest < 1u << kMaybe)
    log::warning(
        "the images in '{}' are dark: their largest value is {} of 65535; if the camera "
        "has 14 bits, multiply them by 4",
        folder.string(), largest);
  return pictures;
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
  auto pictures = read_pictures(*has_inner ? inner : folder, as);
  if (!pictures) return tl::make_unexpected(pictures.error());
  const auto stamps_ns = recording::read_all_stamps_ns(folder);
  if (!stamps_ns) return tl::make_unexpected(stamps_ns.error());
  const auto lap = timing::Lap::of(*stamps_ns);
  const auto count = pictures->images.size();
  auto times_ns = picture_times_ns(folder, count, as.rate_hz, lap.first_ns);
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  auto loop = timing::Loop::make(std::move(*times_ns), lap, as.epoch_ns, as.loop,
                                 seconds_to_ns(1 / as.rate_hz));
  if (!loop) return fail_in("camera_timestamps.npy", loop.error());
  return PlayedPictures{std::make_unique<PngPictures>(std::move(pictures->images), as.exposure_ns),
                        recording::Schedule(std::move(*loop), count)};
}

}  // namespace handcast::camera
