// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/png.hpp"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace handcast::simulate {
namespace {

Result<void> write(const std::filesystem::path& file, const cv::Mat& image) {
  try {
    if (cv::imwrite(file.string(), image, {cv::IMWRITE_PNG_COMPRESSION, 1})) return {};
  } catch (const cv::Exception&) {
  }
  return fail(Errc::bad_config, fmt::format("{}: the picture cannot be written", file.string()));
}

bool is_numbered_png(const std::filesystem::path& file) {
  const auto stem = file.stem().string();
  return file.extension() == ".png" && stem.size() == 6 &&
         stem.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::filesystem::path numbered_png(const std::filesystem::path& folder, std::size_t number) {
  return folder / fmt::format("{:06}.png", number);
}

Result<void> remove_numbered_pngs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    if (is_numbered_png(entry->path())) files.push_back(entry->path());
  for (const auto& file : files)
    if (std::filesystem::remove(file, failed); failed)
      return fail(Errc::bad_config,
                  fmt::format("{}: cannot be removed: {}", file.string(), failed.message()));
  return {};
}

Result<void> write_png(const std::filesystem::path& file, renderer::View<const std::uint8_t> grey) {
  return write(file, cv::Mat(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data),
                             static_cast<std::size_t>(grey.stride)));
}

Result<void> write_png(const std::filesystem::path& file,
                       renderer::View<const std::uint32_t> colour) {
  const cv::Mat rgba(colour.height, colour.width, CV_8UC4, const_cast<std::uint32_t*>(colour.data),
                     static_cast<std::size_t>(colour.stride) * 4);
  cv::Mat bgr;
  cv::cvtColor(rgba, bgr, cv::COLOR_RGBA2BGR);
  return write(file, bgr);
}

}  // namespace handcast::simulate
