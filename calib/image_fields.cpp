// SPDX-License-Identifier: Apache-2.0
#include "calib/image_fields.hpp"

#include <algorithm>

namespace handcast::calib {
namespace {

constexpr std::array kNames{"top left", "top",         "top right", "left",        "middle",
                            "right",    "bottom left", "bottom",    "bottom right"};

}  // namespace

void ImageFields::add(const glm::dvec2& px) {
  const double x = kSide * (px.x + 0.5) / width_px_, y = kSide * (px.y + 0.5) / height_px_;
  if (!(x >= 0 && x < kSide && y >= 0 && y < kSide)) return;
  const int field = static_cast<int>(y) * kSide + static_cast<int>(x);
  ++counts_[static_cast<std::size_t>(field)];
}

std::string ImageFields::emptiest() const {
  return kNames[static_cast<std::size_t>(std::ranges::min_element(counts_) - counts_.begin())];
}

std::vector<std::string> ImageFields::with_fewer_than(int points) const {
  std::vector<std::string> names;
  for (std::size_t field = 0; field < counts_.size(); ++field)
    if (counts_[field] < points) names.emplace_back(kNames[field]);
  return names;
}

}  // namespace handcast::calib
