// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "services/tools/calibrate/pattern_images.hpp"

/// How a projector turns grey levels into light.
namespace handcast::calibrate {

/// A grey level that was projected, and the light that was seen.
struct GreyStep {
  double level = 0;  ///< that the projector was given, 0..1
  double share = 0;  ///< its light as a share of that of the brightest level
};

/// How a projector turns levels into light.
struct GammaFit {
  double gamma = 0;           ///< light = level^gamma
  double low = 0, high = 0;   ///< 95 % interval of gamma
  double misfit = 0;          ///< of the shares, mean absolute difference
  double misfit_of_srgb = 0;  ///< the same for the curve of sRGB (IEC 61966-2-1)
  double noise = 0;           ///< of the shares about the better curve, median absolute difference
  bool is_srgb() const { return misfit_of_srgb <= misfit; }
  /// The value of projector.gamma.
  double setting() const { return is_srgb() ? 0 : gamma; }
};

/// The light of a level by a setting of projector.gamma, as a share of that of `brightest`.
double share_of(double level, double brightest, double gamma_setting);

/// Fits the exponent by least absolute differences of the shares; the interval is that of 200
/// resamples of the steps (percentiles). `brightest`: the level whose share is 1. Errors: bad_data
/// (fewer than 5 levels; the light does not grow with the level; an exponent below 0.3 or above 5).
Result<GammaFit> fit_gamma(std::span<const GreyStep> steps, double brightest);

/// Whether a setting of projector.gamma explains the steps clearly worse than the fit does. An
/// exponent near 2.2 and sRGB differ by less than a camera's noise.
bool is_clearly_worse(double gamma_setting, std::span<const GreyStep> steps, double brightest,
                      const GammaFit& fit);

/// A picture of the steps, of the fitted curve and of the one that the rig's setting
/// `gamma_setting` stands for.
Picture gamma_picture(std::span<const GreyStep> steps, double brightest, const GammaFit& fit,
                      double gamma_setting);

/// Measures by projected grey steps how the projector turns levels into light, and adds the
/// findings, a picture and the value of projector.gamma to an outcome. Takes some seconds. If the
/// camera cannot tell, a finding says so. Errors: those of the streams and of the rig.
Result<void> measure_gamma(Desk& desk, PatternImages& patterns, Outcome& outcome);

}  // namespace handcast::calibrate
