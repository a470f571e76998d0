// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <iterator>
#include <numbers>
#include <span>
#include <unsupported/Eigen/FFT>

#include "services/content/sound/sound.hpp"

namespace handcast::content {
namespace {

constexpr int kSpan = 2 * Spectrum::kBins;

/// Hann's window, by which a sine of amplitude 1 has the level 1.
std::array<float, kSpan> window() {
  std::array<float, kSpan> weights{};
  for (int i = 0; i < kSpan; ++i)
    weights[static_cast<std::size_t>(i)] =
        static_cast<float>(2. / kSpan * (1 - std::cos(2 * std::numbers::pi * (i + 0.5) / kSpan)));
  return weights;
}

float centred(float sample) { return std::clamp(0.5f + 0.5f * sample, 0.f, 1.f); }

}  // namespace

SoundImage waveform_of(const Heard& heard, int width) {
  SoundImage image{width, static_cast<int>(heard.channels.size()), {}};
  for (const auto& samples : heard.channels)
    std::transform(samples.end() - width, samples.end(), std::back_inserter(image.levels), centred);
  return image;
}

struct Spectrum::Transform {
  Eigen::FFT<float> fft{Eigen::FFT<float>::impl_type(), Eigen::FFT<float>::HalfSpectrum};
  const std::array<float, kSpan> weights = window();
  std::vector<float> samples = std::vector<float>(kSpan);
  std::vector<std::complex<float>> bins;
};

Spectrum::Spectrum() : transform_(std::make_unique<Transform>()), amplitudes_(kBins) {}
Spectrum::~Spectrum() = default;

const std::vector<float>& Spectrum::amplitudes(const std::vector<float>& samples) {
  auto& [fft, weights, weighted, bins] = *transform_;
  std::transform(samples.end() - kSpan, samples.end(), weights.begin(), weighted.begin(),
                 std::multiplies<>());
  fft.fwd(bins, weighted);
  std::transform(bins.begin(), bins.begin() + kBins, amplitudes_.begin(),
                 [](const std::complex<float>& bin) { return std::abs(bin); });
  return amplitudes_;
}

SoundImage Spectrum::image_of(const Heard& heard, int width) {
  SoundImage image{width, static_cast<int>(heard.channels.size()), {}};
  for (const auto& samples : heard.channels) {
    const std::span bins(amplitudes(samples));
    for (int x = 0; x < width; ++x) {
      const auto first = static_cast<std::size_t>(x * kBins / width),
                 end = std::max(first + 1, static_cast<std::size_t>((x + 1) * kBins / width));
      image.levels.push_back(std::ranges::max(bins.subspan(first, end - first)));
    }
  }
  return image;
}

SoundImage Spectrum::shadertoy_image_of(const Heard& heard) {
  std::vector<float> mean(kHeardSamples);
  for (const auto& samples : heard.channels)
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += samples[i] / static_cast<float>(heard.channels.size());
  const auto level = [](float amplitude) {
    return std::clamp((20 * std::log10(std::max(amplitude, 1e-6f)) + 100) / 70, 0.f, 1.f);
  };
  SoundImage image{kBins / 2, 2, {}};
  const auto& bins = amplitudes(mean);
  std::transform(bins.begin(), bins.begin() + image.width, std::back_inserter(image.levels), level);
  std::transform(mean.end() - image.width, mean.end(), std::back_inserter(image.levels), centred);
  return image;
}

}  // namespace handcast::content
