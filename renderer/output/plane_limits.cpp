// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/plane_limits.hpp"

#include <limits>

#include "renderer/output/light.hpp"

namespace handcast::renderer {

template <class Value>
PlaneLimits<Value>::PlaneLimits(const config::Projector& settings, int planes,
                                const std::array<Value, 256>& values)
    : settings_(settings),
      dither_(planes),
      values_(values),
      limits_(planes * static_cast<std::size_t>(to_next_plane())) {}

template <class Value>
std::vector<Value> PlaneLimits<Value>::limits_for(int count, std::span<const float> light) const {
  std::vector<Value> limits;
  std::size_t level = 1;  // the first one with more light than the threshold
  for (int i = 0; i < count; ++i) {
    const double threshold = (i + 0.5) / count;
    while (level < light.size() && light[level] <= threshold) ++level;
    if (level == light.size()) break;
    const double share = (threshold - light[level - 1]) / (light[level] - light[level - 1]);
    limits.push_back(
        static_cast<Value>(values_[level - 1] + share * (values_[level] - values_[level - 1])));
  }
  limits.resize(static_cast<std::size_t>(count), std::numeric_limits<Value>::max());  // never lit
  return limits;
}

template <class Value>
void PlaneLimits<Value>::set_fade(double fade) {
  const double brightness = settings_.brightness * fade;
  auto light = light_of_levels();
  if (settings_.dither)
    for (float& each : light) each *= static_cast<float>(brightness);
  const auto limits = limits_for(settings_.dither ? dither_.thresholds() : 1, light);
  const auto limit_at = [&](int plane, int x, int y) {
    if (settings_.dither) return limits[static_cast<std::size_t>(dither_.at(plane, x, y))];
    const bool is_lit = dither_.turn(plane) < brightness * dither_.planes();
    return is_lit ? limits[0] : std::numeric_limits<Value>::max();
  };
  for (int plane = 0; plane < dither_.planes(); ++plane)
    for (int y = 0; y < size(); ++y) {
      Value* row = limits_.data() + static_cast<std::ptrdiff_t>(plane * size() + y) * row_size();
      for (int x = 0; x < size(); ++x) row[x] = limit_at(plane, x, y);
      for (int x = size(); x < row_size(); ++x) row[x] = row[x - size()];
    }
}

template class PlaneLimits<std::uint8_t>;
template class PlaneLimits<std::uint16_t>;

}  // namespace handcast::renderer
