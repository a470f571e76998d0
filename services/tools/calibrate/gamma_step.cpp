// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/gamma_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "renderer/output/light.hpp"
#include "services/tools/calibrate/light/gamma_fit.hpp"

namespace handcast::calibrate {
namespace {

constexpr int kRounds = 3;
/// In no order, so that what moves meanwhile does not look like a curve.
constexpr std::array<std::uint8_t, 8> kLevels{128, 48, 208, 80, 240, 24, 176, 104};
constexpr int kLeastContrast = 12, kSaturated = 235, kNoise = 8;  ///< grey values

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
double share_of(const References& before, const References& after,
                const PatternImages::Image& image) {
  constexpr long kLeastPixels = 500;
  constexpr double kMostMoved = 0.08;  // of the light
  double light = 0, whole = 0, moved = 0;
  long pixels = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (before.white[i] - before.black[i] < kLeastContrast || before.white[i] >= kSaturated)
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
      if (const double share = share_of(*before, *after, *image); share > 0)
        steps.push_back({table[level] / 255.0, share});
      before = std::move(after);
    }
  return steps;
}

void report(const config::Projector& projector, std::span<const GreyStep> steps, double brightest,
            const GammaFit& fit, Outcome& outcome) {
  constexpr double kSame = 0.08;
  outcome.pictures += gamma_svg(steps, brightest, fit, projector.gamma);
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
