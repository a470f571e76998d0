#include "renderer/content/opencv_picture.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace handcast::renderer {
namespace {

constexpr int kLargestSide = 8192;

cv::Mat read_bgr(const std::string& file) {
  try {
    return cv::imread(file, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

Result<Texture> read_picture(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return fail(Errc::bad_config, fmt::format("There is no picture file '{}'.", file));
  const cv::Mat picture = read_bgr(file);
  if (picture.empty()) return fail(Errc::bad_config, fmt::format("'{}' is not a PNG or JPEG picture.", file));
  if (std::max(picture.cols, picture.rows) > kLargestSide) {
    return fail(Errc::bad_config,
                fmt::format("The picture '{}' is {}x{} px; {} px a side are allowed.", file, picture.cols, picture.rows, kLargestSide));
  }
  Texture texture(picture.cols, picture.rows);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto bgr = picture.at<cv::Vec3b>(y, x);
      texture.at(x, y) = 0xff000000u | static_cast<std::uint32_t>(bgr[0]) << 16 | static_cast<std::uint32_t>(bgr[1]) << 8 | bgr[2];
    }
  }
  return texture;
}

Image<std::uint8_t> lettering(const std::string& text, int height) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX, kThickness = 2;
  const double scale = cv::getFontScaleFromHeight(kFont, height - 2 * kThickness, kThickness);
  int below = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, kThickness, &below);
  cv::Mat page(height, size.width + 2 * kThickness, CV_8UC1, cv::Scalar(0));
  cv::putText(page, text, {kThickness, height - kThickness}, kFont, scale, cv::Scalar(255), kThickness, cv::LINE_AA);
  Image<std::uint8_t> letters(page.cols, page.rows);
  for (int y = 0; y < page.rows; ++y) std::copy_n(page.ptr<std::uint8_t>(y), page.cols, letters.row(y));
  return letters;
}

}  // namespace handcast::renderer
