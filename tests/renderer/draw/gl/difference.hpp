// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer::test {

/// Mean, 99th percentile and maximum of the samples added.
class Spread {
 public:
  void add(float sample) { samples_.push_back(sample); }
  double mean() const {
    double sum = 0;
    for (const float one : samples_) sum += one;
    return samples_.empty() ? 0 : sum / static_cast<double>(samples_.size());
  }
  double share(double part) const {
    if (samples_.empty()) return 0;
    std::vector<float> sorted = samples_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
  double p99() const { return share(0.99); }
  double max() const { return share(1); }

 private:
  std::vector<float> samples_;
};

/// How much the images of one painter differ from those of another.
struct Difference {
  int lit_px = 0;      ///< pixels lit by either
  int surface_px = 0;  ///< of these: other surface ids, or lit by one only
  Spread uv;           ///< distance of the texture coordinates where the ids are equal
  Spread colour;       ///< largest difference of a channel there, 0..255

  void add(Painter& one, Painter& other, const Rect& region) {
    const auto uv1 = one.uv(), uv2 = other.uv();
    const auto surface1 = one.surface(), surface2 = other.surface();
    const auto colour1 = one.colour(), colour2 = other.colour();
    for (int y = region.y0; y < region.y1; ++y) {
      for (int x = region.x0; x < region.x1; ++x) {
        const SurfaceId id = surface1.at(x, y);
        if (id == 0 && surface2.at(x, y) == 0) continue;
        ++lit_px;
        if (id != surface2.at(x, y)) {
          ++surface_px;
          continue;
        }
        uv.add(glm::distance(uv1.at(x, y), uv2.at(x, y)));
        colour.add(static_cast<float>(channel_difference(colour1.at(x, y), colour2.at(x, y))));
      }
    }
  }
  /// Share of the lit pixels with other surface ids.
  double surface_share() const { return lit_px ? static_cast<double>(surface_px) / lit_px : 0; }

  std::string line() const {
    return fmt::format(
        "{} px, {} with another surface ({:.1e}); uv mean {:.1e}, p99 {:.1e}, max {:.1e}; colour "
        "mean {:.2g}, p99 {:g}, max {:g}",
        lit_px, surface_px, surface_share(), uv.mean(), uv.p99(), uv.max(), colour.mean(),
        colour.p99(), colour.max());
  }

 private:
  static int channel_difference(std::uint32_t a, std::uint32_t b) {
    int most = 0;
    for (int shift = 0; shift < 32; shift += 8)
      most = std::max(most, std::abs(static_cast<int>(a >> shift & 0xff) -
                                     static_cast<int>(b >> shift & 0xff)));
    return most;
  }
};

}  // namespace handcast::renderer::test
