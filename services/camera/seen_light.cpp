// SPDX-License-Identifier: Apache-2.0
#include "services/camera/seen_light.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "renderer/output/light.hpp"

namespace handcast::camera {
namespace {

constexpr std::size_t kKept = 4;  ///< pictures; a camera is a few of its images behind at most

/// The light of the levels 0..255 in the same range.
std::array<std::uint8_t, 256> linear_levels() {
  std::array<std::uint8_t, 256> linear{};
  const auto light = renderer::light_of_levels();
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = static_cast<std::uint8_t>(std::lround(255 * light[i]));
  return linear;
}

}  // namespace

void SeenLight::add(const msg::Projection& projection) {
  static const auto kLinear = linear_levels();
  if (!lit_.empty() && lit_.back().test_picture == projection.test_picture) return;
  Lit lit{projection.lit_ns + late_ns_,
          projection.test_picture,
          static_cast<int>(projection.region_width_px),
          static_cast<int>(projection.region_height_px),
          {}};
  if (projection.test_picture != 0) {
    lit.grey.resize(static_cast<std::size_t>(lit.width_px) *
                    static_cast<std::size_t>(lit.height_px));
    for (std::size_t i = 0; i < lit.grey.size(); ++i)
      lit.grey[i] = kLinear[projection.pixels()[i] & 255];
  }
  lit_.push_back(std::move(lit));
  if (lit_.size() > kKept) lit_.pop_front();
}

std::optional<twin::Light> SeenLight::at(std::int64_t time_ns) const {
  const Lit* newest = nullptr;
  for (const auto& lit : lit_)
    if (lit.from_ns <= time_ns) newest = &lit;
  if (!newest || newest->grey.empty()) return std::nullopt;
  return twin::Light{newest->grey.data(), newest->width_px, newest->height_px};
}

}  // namespace handcast::camera
