// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/pattern_check.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace handcast::calib {

double pattern_misfit(const GreyView& white, const GreyView& black, const GreyView& pattern,
                      const GreyView& inverse) {
  constexpr int kLeastContrast = 16;
  constexpr double kPercentile = 0.7;
  struct Lit {
    int contrast, off;
  };
  std::vector<Lit> lit;
  for (int y = 0; y < white.height_px; ++y) {
    const auto *w = white.pixels + y * white.stride, *b = black.pixels + y * black.stride,
               *p = pattern.pixels + y * pattern.stride, *i = inverse.pixels + y * inverse.stride;
    for (int x = 0; x < white.width_px; ++x)
      if (const int contrast = w[x] - b[x]; contrast >= kLeastContrast)
        lit.push_back({contrast, std::abs(p[x] + i[x] - w[x] - b[x])});
  }
  if (lit.empty()) return 0;
  // The brighter half: noise is large where little light is.
  const auto half = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  std::ranges::nth_element(lit, half, {}, &Lit::contrast);
  std::vector<double> misfits;
  for (auto pixel = half; pixel != lit.end(); ++pixel)
    misfits.push_back(pixel->off / static_cast<double>(pixel->contrast));
  const auto at = misfits.begin() + static_cast<std::ptrdiff_t>(
                                        kPercentile * static_cast<double>(misfits.size() - 1));
  std::ranges::nth_element(misfits, at);
  return *at;
}

}  // namespace handcast::calib
