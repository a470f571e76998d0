// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/backends/camera/seen_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/output/light.hpp"

namespace handcast::camera {
namespace {

constexpr std::size_t kKept = 4;  ///< pictures; a camera is a few of its images behind at most

}  // namespace

TrueLight true_light(const config::Projector& settings, double true_gamma) {
  const auto table = renderer::light_table(settings);
  const auto as_in_srgb = renderer::light_of_levels();
  TrueLight light{};
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double made = true_gamma == 0 ? static_cast<double>(as_in_srgb[table[i]])
                                        : std::pow(table[i] / 255.0, true_gamma);
    light[i] = static_cast<std::uint8_t>(std::lround(255 * made));
  }
  return light;
}

SeenLight::SeenLight(std::int64_t late_ns, std::int64_t period_ns, const TrueLight& light)
    : late_ns_(late_ns), period_ns_(period_ns), light_(light) {}

void SeenLight::add(const msg::Projection& projection) {
  if (!lit_.empty() && lit_.back().test_picture == projection.test_picture) return;
  Lit lit{projection.lit_ns - period_ns_ / 2 + late_ns_,
          projection.test_picture,
          static_cast<int>(projection.region_width_px),
          static_cast<int>(projection.region_height_px),
          {}};
  if (projection.test_picture != 0) {
    lit.grey.resize(static_cast<std::size_t>(lit.width_px) *
                    static_cast<std::size_t>(lit.height_px));
    for (std::size_t i = 0; i < lit.grey.size(); ++i)
      lit.grey[i] = light_[projection.pixels()[i] & 255];
  }
  lit_.push_back(std::move(lit));
  if (lit_.size() > kKept) lit_.pop_front();
}

/// The pictures that are lit between two times. Each one ends where the next one begins.
std::vector<SeenLight::Part> SeenLight::parts_of(std::int64_t from_ns, std::int64_t to_ns) const {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    const auto end_ns =
        i + 1 < lit_.size() ? lit_[i + 1].from_ns : std::numeric_limits<std::int64_t>::max();
    const auto part_ns = std::min(to_ns, end_ns) - std::max(from_ns, lit_[i].from_ns);
    if (part_ns > 0 && !lit_[i].grey.empty())
      parts.push_back(
          {&lit_[i], static_cast<double>(part_ns) / static_cast<double>(to_ns - from_ns)});
  }
  return parts;
}

std::optional<twin::Light> SeenLight::during(std::int64_t middle_ns, std::int64_t exposure_ns) {
  constexpr double kAll = 0.999;
  const auto half_ns = std::max<std::int64_t>(exposure_ns / 2, 1);
  const auto parts = parts_of(middle_ns - half_ns, middle_ns + half_ns);
  if (parts.empty()) return std::nullopt;
  const Lit& first = *parts.front().lit;
  if (parts.front().share > kAll)
    return twin::Light{first.grey.data(), first.width_px, first.height_px};
  mix_.assign(first.grey.size(), 0);
  for (std::size_t i = 0; i < mix_.size(); ++i) {
    double light = 0;
    for (const auto& part : parts)
      if (part.lit->grey.size() == mix_.size()) light += part.share * part.lit->grey[i];
    mix_[i] = static_cast<std::uint8_t>(std::lround(light));
  }
  return twin::Light{mix_.data(), first.width_px, first.height_px};
}

}  // namespace handcast::camera
