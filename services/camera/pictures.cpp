// SPDX-License-Identifier: Apache-2.0
#include "services/camera/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/content/picture.hpp"

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

}  // namespace

Result<std::vector<renderer::Image<std::uint8_t>>> read_pictures(const fs::path& folder,
                                                                 int width_px, int height_px) {
  const auto files = list_pictures(folder);
  if (!files) return tl::make_unexpected(files.error());
  if (files->size() * width_px * height_px > kMostBytes)
    return fail(
        Errc::bad_config,
        fmt::format("'{}' has {} images, which take more than 1 GiB of memory; replay fewer",
                    folder.string(), files->size()));
  std::vector<renderer::Image<std::uint8_t>> images;
  for (const auto& file : *files) {
    auto image = read_picture(file, width_px, height_px);
    if (!image) return tl::make_unexpected(image.error());
    images.push_back(std::move(*image));
  }
  return images;
}

}  // namespace handcast::camera
