// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/lettering.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace handcast::renderer {
namespace {

enum class Below { cut, shown };

Image<std::uint8_t> letters_of(const std::string& text, int height, Below descenders) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX, kThickness = 2;
  const double scale = cv::getFontScaleFromHeight(kFont, height - 2 * kThickness, kThickness);
  int below = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, kThickness, &below);
  const int more = descenders == Below::shown ? below + kThickness : 0;
  cv::Mat page(height + more, size.width + 2 * kThickness, CV_8UC1, cv::Scalar(0));
  cv::putText(page, text, {kThickness, height - kThickness}, kFont, scale, cv::Scalar(255),
              kThickness, cv::LINE_AA);
  Image<std::uint8_t> letters(page.cols, page.rows);
  for (int y = 0; y < page.rows; ++y)
    std::copy_n(page.ptr<std::uint8_t>(y), page.cols, letters.row(y));
  return letters;
}

}  // namespace

Image<std::uint8_t> lettering(const std::string& text, int height) {
  return letters_of(text, height, Below::cut);
}

Image<std::uint8_t> whole_lettering(const std::string& text, int height) {
  return letters_of(text, height, Below::shown);
}

}  // namespace handcast::renderer
