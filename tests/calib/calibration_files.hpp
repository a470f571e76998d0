// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace handcast::calib {

/// A file with this text. The next call replaces it.
inline std::filesystem::path file_with(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "handcast_calibration_test.toml";
  std::ofstream(file) << text;
  return file;
}

/// The largest difference of two matrices' elements.
double largest_difference(const auto& a, const auto& b) {
  double largest = 0;
  for (int column = 0; column < a.length(); ++column)
    for (int row = 0; row < a[0].length(); ++row)
      largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
  return largest;
}

}  // namespace handcast::calib
