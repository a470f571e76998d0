// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "renderer/media/picture.hpp"
#include "services/studies/jnd/course.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

/// How many subjects have marked each place.
struct Marks {
  renderer::Image<std::uint16_t> counts;
  int subjects = 0;

  void add(const renderer::Image<std::uint8_t>& marks) {
    if (subjects == 0) counts = renderer::Image<std::uint16_t>(marks.width(), marks.height());
    if (marks.width() != counts.width() || marks.height() != counts.height()) return;
    ++subjects;
    for (std::size_t i = 0; i < marks.pixels().size(); ++i)
      counts.pixels()[i] =
          static_cast<std::uint16_t>(counts.pixels()[i] + (marks.pixels()[i] > 127));
  }
};

/// Dark over red and yellow to white. `share`: 0..1.
std::uint32_t heat(double share) {
  const auto part = [share](double from) {
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(3 * (share - from), 0.0, 1.0)));
  };
  return 0xff000000u | part(2.0 / 3) << 16 | part(1.0 / 3) << 8 | part(0);
}

}  // namespace

std::optional<renderer::Texture> heat_map(const std::vector<std::string>& files) {
  std::array<Marks, kConditionNames.size()> all;
  for (const auto& file : files) {
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(file, failed))
      for (std::size_t c = 0; c < all.size(); ++c)
        if (entry.path().string().ends_with(fmt::format(".{}.marks.png", kConditionNames[c])))
          if (const auto marks = renderer::read_camera_picture(entry.path()))
            all[c].add(marks->grey);
  }
  const auto& first = all[0].subjects > 0 ? all[0] : all[1];
  if (first.subjects == 0) return {};
  const int width = first.counts.width(), height = first.counts.height();
  renderer::Texture map(static_cast<int>(all.size()) * width, height, 0xff000000u);
  for (std::size_t c = 0; c < all.size(); ++c) {
    const auto& counts = all[c].counts;
    if (counts.width() != width || counts.height() != height) continue;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        map.at(static_cast<int>(c) * width + x, y) =
            heat(static_cast<double>(counts.at(x, y)) / all[c].subjects);
  }
  return map;
}

}  // namespace handcast::study
