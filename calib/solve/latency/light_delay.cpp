// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/latency/light_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "ipc/base/statistics.hpp"

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

/// Bright less dark: the levels that 10 % of the images are above, and below.
double contrast_of(std::span<const Brightness> images) {
  std::vector<double> greys;
  for (const auto& image : images) greys.push_back(image.grey);
  return quantile(greys, 0.9) - quantile(greys, 0.1);
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

/// The squared errors of the line that explains the images around a toggle by the share of their
/// exposure after it: what a person moves in front of the camera meanwhile changes the levels of
/// dark and bright from toggle to toggle.
class LineFit {
 public:
  void add(double share, double grey) {
    ++count_;
    shares_ += share;
    greys_ += grey;
    share_squares_ += share * share;
    grey_squares_ += grey * grey;
    products_ += share * grey;
  }
  /// `is_rising`: the line must not fall, else it must not rise.
  double squared_errors(bool is_rising) const {
    const double shares = share_squares_ - shares_ * shares_ / count_,
                 greys = grey_squares_ - greys_ * greys_ / count_,
                 products = products_ - shares_ * greys_ / count_;
    if (shares < 1e-9 || (products > 0) != is_rising) return greys;
    return std::max(0.0, greys - products * products / shares);
  }

 private:
  double count_ = 0, shares_ = 0, greys_ = 0;
  double share_squares_ = 0, grey_squares_ = 0, products_ = 0;
};

/// In the unit of the contrast.
Curve curve_of(const Toggle& toggle, std::span<const Brightness> images, double contrast) {
  Curve curve(kSteps, 0.0);
  for (int step = 0; step < kSteps; ++step) {
    LineFit line;
    for (const auto& image : images) {
      const double exposure_ms = std::max(ms_of(image.exposure_ns), kStep_ms);
      const double end_ms = ms_of(image.origin_ns - toggle.begin_ns) + exposure_ms / 2;
      line.add(std::clamp((end_ms - delay_of(step)) / exposure_ms, 0.0, 1.0),
               image.grey / contrast);
    }
    curve[static_cast<std::size_t>(step)] = line.squared_errors(toggle.is_bright);
  }
  return curve;
}

/// The delays of the least error: between two images nothing is known, so that several steps share
/// it.
struct Best {
  double first_ms = 0, last_ms = 0;
  double middle_ms() const { return (first_ms + last_ms) / 2; }
};

Best best_of(const Curve& curve) {
  const double least = *std::ranges::min_element(curve), same = least + 1e-9 + 1e-6 * least;
  const auto is_best = [&](double error) { return error <= same; };
  const auto first = std::ranges::find_if(curve, is_best) - curve.begin();
  const auto last = std::find_if(curve.rbegin(), curve.rend(), is_best).base() - 1 - curve.begin();
  return {delay_of(static_cast<int>(first)), delay_of(static_cast<int>(last))};
}

void add(Curve& sum, const Curve& curve) {
  std::ranges::transform(sum, curve, sum.begin(), std::plus());
}

double median_error_ms(std::span<const Brightness> images) {
  std::vector<std::int64_t> errors_ns;
  for (const auto& image : images) errors_ns.push_back(image.error_ns);
  return ms_of(median(std::move(errors_ns)));
}

/// Without the errors of the images' times.
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
    delays.push_back(best_of(sum).middle_ms());
  }
  const auto best = best_of(all);
  return {best.middle_ms(), std::min(quantile(delays, 0.025), best.first_ms) - kStep_ms,
          std::max(quantile(delays, 0.975), best.last_ms) + kStep_ms, best.last_ms - best.first_ms,
          contrast};
}

}  // namespace

Result<LightDelay> fit_light_delay(std::span<const Toggle> toggles,
                                   std::span<const Brightness> images) {
  std::vector<Curve> curves;
  if (images.empty() || toggles.size() < kLeastToggles)
    return fail(Errc::unavailable, fmt::format("{} changes of the light and {} images are too few",
                                               toggles.size(), images.size()));
  const double contrast = contrast_of(images);
  if (!(contrast >= kLeastContrast))
    return fail(Errc::bad_data,
                fmt::format("the camera does not see the projector's light: bright and dark differ "
                            "by {:.1f} grey values",
                            contrast));
  for (std::size_t i = 0; i < toggles.size(); ++i)
    if (const auto near = around(toggles, i, images); toggles[i].is_sure && near.size() >= 2)
      curves.push_back(curve_of(toggles[i], near, contrast));
  if (curves.size() < kLeastToggles)
    return fail(Errc::unavailable,
                fmt::format("only {} of {} changes of the light were seen with their images: the "
                            "computer is too busy, or the camera too slow",
                            curves.size(), toggles.size()));
  auto delay = with_interval(curves, contrast);
  const double error_ms = median_error_ms(images);
  delay.low_ms -= error_ms;
  delay.high_ms += error_ms;
  if (std::abs(delay.delay_ms) > kLongestDelay_ms - 1)
    return fail(Errc::bad_config,
                fmt::format("the light comes more than {:g} ms from the time that "
                            "the projector reports: correct projector.latency_ms",
                            kLongestDelay_ms));
  return delay;
}

}  // namespace handcast::calib
