// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/gamma.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "ipc/base/statistics.hpp"
#include "renderer/base/srgb.hpp"
#include "renderer/output/light.hpp"

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

constexpr int kRounds = 3;
/// In no order, so that what moves meanwhile does not look like a curve.
constexpr std::array<std::uint8_t, 8> kLevels{128, 48, 208, 80, 240, 24, 176, 104};
constexpr int kLeastContrast = 12, kSaturatedWhite = 235, kNoise = 8;  ///< grey values

/// The images of full light and of none, before or after a step.
struct References {
  PatternImages::Image white, black;
};

Result<References> take_references(PatternImages& patterns) {
  auto white = patterns.image_of_level(255);
  if (!white) return tl::make_unexpected(white.error());
  auto black = patterns.image_of_level(0);
  if (!black) return tl::make_unexpected(black.error());
  return References{std::move(*white), std::move(*black)};
}

/// The light of an image as a share of that of white, over the pixels in which white is seen and is
/// not saturated; 0 if there are too few, or if something moved between the references. The pixels
/// are chosen by the references before and measured by those after: noise that helps a pixel to be
/// chosen must not be in its light.
double light_share(const References& before, const References& after,
                   const PatternImages::Image& image) {
  constexpr long kLeastPixels = 500;
  constexpr double kMostMoved = 0.08;  // of the light
  double light = 0, whole = 0, moved = 0;
  long pixels = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (before.white[i] - before.black[i] < kLeastContrast || before.white[i] >= kSaturatedWhite)
      continue;
    light += image[i] - after.black[i];
    whole += after.white[i] - after.black[i];
    moved += std::max(0, std::abs(before.white[i] - after.white[i]) - kNoise);
    ++pixels;
  }
  return pixels < kLeastPixels || moved > kMostMoved * whole ? 0 : light / whole;
}

/// Each step is between two pairs of references, because a board in a hand moves.
Result<std::vector<GreyStep>> take_steps(PatternImages& patterns,
                                         const renderer::LightTable& table) {
  std::vector<GreyStep> steps;
  auto before = take_references(patterns);
  if (!before) return tl::make_unexpected(before.error());
  for (int round = 0; round < kRounds; ++round)
    for (const auto level : kLevels) {
      const auto image = patterns.image_of_level(level);
      if (!image) return tl::make_unexpected(image.error());
      auto after = take_references(patterns);
      if (!after) return tl::make_unexpected(after.error());
      if (const double share = light_share(*before, *after, *image); share > 0)
        steps.push_back({table[level] / 255.0, share});
      before = std::move(after);
    }
  return steps;
}

void report(const config::Projector& projector, std::span<const GreyStep> steps, double brightest,
            const GammaFit& fit, Outcome& outcome) {
  constexpr double kSame = 0.08;
  outcome.pictures.push_back(gamma_picture(steps, brightest, fit, projector.gamma));
  const auto measured =
      fmt::format("level^{:.2f} ({:.2f} to {:.2f}, 95 %)", fit.gamma, fit.low, fit.high);
  const bool is_right = !is_clearly_worse(projector.gamma, steps, brightest, fit) ||
                        (projector.gamma > 0 && std::abs(fit.gamma - projector.gamma) < kSame);
  if (is_right) {
    outcome.findings.push_back(
        fmt::format("grey levels are as the rig says, projector.gamma = {:g}: the light is {}{}",
                    projector.gamma, measured, fit.is_srgb() ? ", and fits sRGB better" : ""));
    return;
  }
  const auto value = fit.is_srgb() ? std::string("0") : fmt::format("{:.2f}", fit.gamma);
  outcome.findings.push_back(fmt::format(
      "the light is {}{}: set projector.gamma = {} so that grey levels and fades are right. The "
      "camera counts as linear; the gamma of a webcam is in this figure, too",
      measured, fit.is_srgb() ? ", and fits sRGB better" : "", value));
  outcome.settings.push_back({"projector.gamma", value});
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

Picture gamma_picture(std::span<const GreyStep> steps, double brightest, const GammaFit& fit,
                      double gamma_setting) {
  constexpr int kPoints = 64;
  Picture picture{"gamma",
                  "The light, as a share of the brightest, by the level that the projector was "
                  "given. Dots: measured. Line: the curve that fits. Dashes: the rig's setting."};
  for (const auto& step : steps) {
    picture.numbers["level"].push_back(step.level);
    picture.numbers["share"].push_back(step.share);
  }
  for (int i = 0; i <= kPoints; ++i) {
    const double level = brightest * i / kPoints;
    picture.numbers["curve_level"].push_back(level);
    picture.numbers["fitted"].push_back(share_of(level, brightest, fit.setting()));
    picture.numbers["set"].push_back(share_of(level, brightest, gamma_setting));
  }
  return picture;
}

Result<void> measure_gamma(Desk& desk, PatternImages& patterns, Outcome& outcome) {
  const auto& projector = desk.rig.projector;
  const auto table = renderer::light_table(projector);
  const auto steps = take_steps(patterns, table);
  if (!steps) return tl::make_unexpected(steps.error());
  const double brightest = table[255] / 255.0;
  if (const auto fit = fit_gamma(*steps, brightest))
    report(projector, *steps, brightest, *fit, outcome);
  else
    outcome.findings.push_back("projector.gamma could not be measured: " + fit.error().what);
  return {};
}

}  // namespace handcast::calibrate
