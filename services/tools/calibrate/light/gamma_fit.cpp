// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/light/gamma_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "ipc/base/statistics.hpp"
#include "renderer/base/srgb.hpp"

namespace handcast::calibrate {
namespace {

constexpr double kLeastGamma = 0.3, kMostGamma = 5;
constexpr std::size_t kLeastLevels = 5;

/// Absolute differences: a busy computer takes some images in the wrong light, and squares would
/// let these decide.
template <class Curve>
double misfit_of(std::span<const GreyStep> steps, const Curve& curve) {
  double sum = 0;
  for (const auto& step : steps) sum += std::abs(step.share - curve(step.level));
  return sum / static_cast<double>(std::max<std::size_t>(steps.size(), 1));
}

double misfit_of_gamma(std::span<const GreyStep> steps, double brightest, double gamma) {
  return misfit_of(steps, [&](double level) { return share_of(level, brightest, gamma); });
}

/// The exponent of the least misfit: golden section search.
double best_gamma(std::span<const GreyStep> steps, double brightest) {
  constexpr double kGolden = 0.6180339887, kExact = 1e-4;
  double low = kLeastGamma, high = kMostGamma;
  while (high - low > kExact) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    if (misfit_of_gamma(steps, brightest, left) < misfit_of_gamma(steps, brightest, right))
      high = right;
    else
      low = left;
  }
  return (low + high) / 2;
}

/// Fewer resamples than the fit has steps would be too few; 200 give the 95 % to a few percent.
std::pair<double, double> interval_of(std::span<const GreyStep> steps, double brightest) {
  constexpr std::size_t kResamples = 200;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, steps.size() - 1);
  std::vector<double> gammas;
  std::vector<GreyStep> sample(steps.size());
  for (std::size_t i = 0; i < kResamples; ++i) {
    for (auto& step : sample) step = steps[any(random)];
    gammas.push_back(best_gamma(sample, brightest));
  }
  return {quantile(gammas, 0.025), quantile(gammas, 0.975)};
}

/// The misfit of a light that is the same at all levels.
double misfit_of_constant(std::span<const GreyStep> steps) {
  std::vector<double> shares;
  for (const auto& step : steps) shares.push_back(step.share);
  const double middle = median(std::move(shares));
  return misfit_of(steps, [&](double) { return middle; });
}

/// The median absolute difference of the steps from the curve of a setting.
double noise_of(std::span<const GreyStep> steps, double brightest, double gamma_setting) {
  std::vector<double> differences;
  for (const auto& step : steps)
    differences.push_back(std::abs(step.share - share_of(step.level, brightest, gamma_setting)));
  return median(std::move(differences));
}

constexpr int kSide_px = 260;  ///< of the picture

std::string point_of(double level, double share) {
  return fmt::format("{:.1f},{:.1f}", level * kSide_px, (1 - share) * kSide_px);
}

std::string curve_svg(double brightest, double gamma_setting, std::string_view style) {
  constexpr int kPoints = 64;
  std::string points;
  for (int i = 0; i <= kPoints; ++i) {
    const double level = brightest * i / kPoints;
    points += point_of(level, share_of(level, brightest, gamma_setting)) + " ";
  }
  return fmt::format("<polyline points='{}' fill='none' stroke='currentColor' {}/>", points, style);
}

}  // namespace

double share_of(double level, double brightest, double gamma_setting) {
  if (gamma_setting == 0) return renderer::srgb_light(level) / renderer::srgb_light(brightest);
  return std::pow(level / brightest, gamma_setting);
}

Result<GammaFit> fit_gamma(std::span<const GreyStep> steps, double brightest) {
  std::set<double> levels;
  for (const auto& step : steps) levels.insert(step.level);
  if (levels.size() < kLeastLevels || !(brightest > 0))
    return fail(Errc::bad_data,
                fmt::format("the light of {} grey levels was seen, and {} are needed",
                            levels.size(), kLeastLevels));
  GammaFit fit;
  fit.gamma = best_gamma(steps, brightest);
  std::tie(fit.low, fit.high) = interval_of(steps, brightest);
  fit.misfit = misfit_of_gamma(steps, brightest, fit.gamma);
  fit.misfit_of_srgb = misfit_of_gamma(steps, brightest, 0);
  fit.noise = noise_of(steps, brightest, fit.setting());
  constexpr double kMostOfConstant = 0.9;
  if (!(fit.misfit < kMostOfConstant * misfit_of_constant(steps)))
    return fail(Errc::bad_data,
                "the light does not grow with the grey level: something moved, or the camera sees "
                "too little of the projector's light");
  constexpr double kAtEdge = 0.01;
  if (fit.gamma < kLeastGamma + kAtEdge || fit.gamma > kMostGamma - kAtEdge)
    return fail(Errc::bad_data,
                fmt::format("the light is level^{:.1f}, which no projector makes: the camera's "
                            "images are saturated or not linear",
                            fit.gamma));
  return fit;
}

bool is_clearly_worse(double gamma_setting, std::span<const GreyStep> steps, double brightest,
                      const GammaFit& fit) {
  constexpr double kClearly = 0.6;  // of the noise
  return misfit_of_gamma(steps, brightest, gamma_setting) -
             std::min(fit.misfit, fit.misfit_of_srgb) >
         kClearly * fit.noise;
}

std::string gamma_svg(std::span<const GreyStep> steps, double brightest, const GammaFit& fit,
                      double gamma_setting) {
  std::string dots;
  for (const auto& step : steps)
    dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2'/>", step.level * kSide_px,
                        (1 - step.share) * kSide_px);
  return fmt::format(
      "<figure><svg width='{2}' viewBox='-34 -12 {2} {1}'>"
      "<path d='M0 0V{0}H{0}' fill='none' stroke='currentColor' stroke-opacity='0.4'/>"
      "<g font-size='12'><text x='-30' y='4'>100 %</text><text x='-12' y='{0}'>0</text>"
      "<text x='0' y='{3}'>0</text><text x='{0}' y='{3}' text-anchor='end'>level 255</text></g>"
      "{4}{5}{6}</svg><figcaption>The light, as a share of the brightest, by the level that the "
      "projector was given. Dots: measured. Line: the curve that fits. Dashes: the rig's setting."
      "</figcaption></figure>",
      kSide_px, kSide_px + 36, kSide_px + 46, kSide_px + 16,
      curve_svg(brightest, fit.setting(), "stroke-width='1.5'"),
      curve_svg(brightest, gamma_setting, "stroke-dasharray='4 4'"), dots);
}

}  // namespace handcast::calibrate
