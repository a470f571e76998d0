// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/lens_memory.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>

#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::calibrate {
namespace {

std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& step) {
  return folder / (step + ".covariance");
}

/// In the order of calib::kLensParameters.
std::array<double, 9> values_of(const calib::CameraModel& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
}

}  // namespace

Result<void> remember_lens(const std::filesystem::path& folder, const std::string& step,
                           const calib::LensFit& fit) {
  std::string text;
  for (const double value : values_of(fit.camera)) text += fmt::format("{} ", value);
  text += "\n";
  for (const auto& row : fit.covariance) {
    for (const double value : row) text += fmt::format("{} ", value);
    text += "\n";
  }
  return write_whole(file_of(folder, step), text);
}

std::optional<calib::LensCovariance> recall_lens(const std::filesystem::path& folder,
                                                 const std::string& step,
                                                 const calib::CameraModel& camera) {
  constexpr double kSame = 1e-6;  // a draft is text
  const auto text = read_input(file_of(folder, step), kMostText);
  if (!text) return {};
  std::istringstream file(*text);
  for (const double wanted : values_of(camera)) {
    double value = 0;
    if (!(file >> value) || std::abs(value - wanted) > kSame * (1 + std::abs(wanted))) return {};
  }
  calib::LensCovariance covariance{};
  for (auto& row : covariance)
    for (double& value : row)
      if (!(file >> value)) return {};
  return covariance;
}

}  // namespace handcast::calibrate
