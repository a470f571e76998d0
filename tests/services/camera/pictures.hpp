// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

namespace handcast::test {

/// Writes `count` images to `folder`; all pixels of image i have the value 10 + i.
inline void write_pictures(const std::filesystem::path& folder, int count, int width_px,
                           int height_px) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < count; ++i)
    cv::imwrite((folder / fmt::format("{:04}.png", i)).string(),
                cv::Mat(height_px, width_px, CV_8UC1, cv::Scalar(10 + i)));
}

}  // namespace handcast::test
