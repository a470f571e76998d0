// SPDX-License-Identifier: Apache-2.0
#include "calib/latency/light_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

namespace handcast::calib {
namespace {

constexpr double kStep_ms = 0.1;
constexpr int kSteps = static_cast<int>(2 * kLongestDelay_ms / kStep_ms) + 1;
constexpr std::size_t kLeastToggles = 6;
constexpr double kLeastContrast = 4;  ///< grey values; the noise of a mean is far below 1

double delay_of(int step) { return step * kStep_ms - kLongestDelay_ms; }
double ms_of(std::int64_t ns) { return 1e-6 * static_cast<double>(ns); }

/// Squared errors by step of the delay, of the images around one toggle.
using Curve = std::vector<double>;

struct Levels {
  double dark = 0, bright = 0;
};

/// The levels that 10 % of the images are below, and above.
Levels levels_of(std::span<const Brightness> images) {
  std::vector<double> greys;
  for (const auto& image : images) greys.push_back(image.grey);
  std::ranges::sort(greys);
  return {greys[greys.size() / 10], greys[greys.size() - 1 - greys.size() / 10]};
}

/// The images between the middles of the times before and after toggle `i`, in which nothing but
/// that toggle happens if the delay is shorter than half of that time.
std::span<const Brightness> around(std::span<const Toggle> toggles, std::size_t i,
                                   std::span<const Brightness> images) {
  constexpr auto kLongest_ns = static_cast<std::int64_t>(kLongestDelay_ms * 1e6);
  const auto middle = [&](std::size_t a, std::size_t b) {
    return toggles[a].begin_ns + (toggles[b].begin_ns - toggles[a].begin_ns) / 2;
  };
  const auto from_ns = i == 0 ? toggles[0].begin_ns - kLongest_ns : middle(i - 1, i);
  const auto to_ns = i + 1 == toggles.size() ? toggles[i].begin_ns + kLongest_ns : middle(i, i + 1);
  const auto time = [](const Brightness& image) { return image.origin_ns; };
  const auto first = std::ranges::lower_bound(images, from_ns, {}, time),
             last = std::ranges::lower_bound(images, to_ns, {}, time);
  return {first, last};
}

Curve curve_of(const Toggle& toggle, std::span<const Brightness> images, const Levels& levels) {
  Curve curve(kSteps, 0.0);
  for (const auto& image : images) {
    const double seen =
        std::clamp((image.grey - levels.dark) / (levels.bright - levels.dark), 0.0, 1.0);
    const double share_after = toggle.is_bright ? seen : 1 - seen;
    const double exposure_ms = std::max(ms_of(image.exposure_ns), kStep_ms);
    const double end_ms = ms_of(image.origin_ns - toggle.begin_ns) + exposure_ms / 2;
    for (int step = 0; step < kSteps; ++step) {
      const double expected = std::clamp((end_ms - delay_of(step)) / exposure_ms, 0.0, 1.0);
      curve[static_cast<std::size_t>(step)] += (share_after - expected) * (share_after - expected);
    }
  }
  return curve;
}

/// The delay of the least error: the middle of the steps that share it, because between two images
/// nothing is known.
double best_of(const Curve& curve) {
  const double least = *std::ranges::min_element(curve), same = least + 1e-9 + 1e-6 * least;
  const auto is_best = [&](double error) { return error <= same; };
  const auto first = std::ranges::find_if(curve, is_best) - curve.begin();
  const auto last = std::find_if(curve.rbegin(), curve.rend(), is_best).base() - 1 - curve.begin();
  return (delay_of(static_cast<int>(first)) + delay_of(static_cast<int>(last))) / 2;
}

void add(Curve& sum, const Curve& curve) {
  std::ranges::transform(sum, curve, sum.begin(), std::plus());
}

LightDelay with_interval(std::span<const Curve> curves, double contrast) {
  constexpr int kResamples = 400;
  Curve all(kSteps, 0.0);
  for (const auto& curve : curves) add(all, curve);
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, curves.size() - 1);
  std::vector<double> delays;
  for (int i = 0; i < kResamples; ++i) {
    Curve sum(kSteps, 0.0);
    for (std::size_t k = 0; k < curves.size(); ++k) add(sum, curves[any(random)]);
    delays.push_back(best_of(sum));
  }
  std::ranges::sort(delays);
  return {best_of(all), delays[kResamples / 40] - kStep_ms,
          delays[kResamples - 1 - kResamples / 40] + kStep_ms, contrast};
}

}  // namespace

Result<LightDelay> fit_light_delay(std::span<const Toggle> toggles,
                                   std::span<const Brightness> images) {
  std::vector<Curve> curves;
  if (images.empty() || toggles.size() < kLeastToggles)
    return fail(Errc::bad_data, fmt::format("{} changes of the light and {} images are too few",
                                            toggles.size(), images.size()));
  const auto levels = levels_of(images);
  const double contrast = levels.bright - levels.dark;
  if (!(contrast >= kLeastContrast))
    return fail(Errc::bad_data,
                fmt::format("the camera does not see the projector's light: bright and dark differ "
                            "by {:.1f} grey values",
                            contrast));
  for (std::size_t i = 0; i < toggles.size(); ++i)
    if (const auto near = around(toggles, i, images); near.size() >= 2)
      curves.push_back(curve_of(toggles[i], near, levels));
  if (curves.size() < kLeastToggles)
    return fail(Errc::bad_data, "the light changed when the camera sent no images");
  const auto delay = with_interval(curves, contrast);
  if (std::abs(delay.delay_ms) > kLongestDelay_ms - 1)
    return fail(Errc::bad_data, fmt::format("the light comes more than {:g} ms from the time that "
                                            "the projector reports",
                                            kLongestDelay_ms));
  return delay;
}

}  // namespace handcast::calib
