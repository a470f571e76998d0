// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/latency/sound_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr double kHalf_s = 0.003;  ///< before and after an edge
constexpr std::size_t kLeastEdges = 6;
constexpr double kLeastStep = 1e-3, kLeastStepInNoise = 5, kMostScatter_ms = 5;

/// By sample: the mean after it minus the mean before it; 0 near the ends.
std::vector<float> steps_of(const SoundClip& clip) {
  const auto half = static_cast<std::size_t>(std::max(2.0, kHalf_s * 1e9 / clip.period_ns));
  const auto& samples = clip.samples;
  std::vector<float> steps(samples.size(), 0.0f);
  if (samples.size() < 2 * half + 1) return steps;
  double before = 0, after = 0;
  for (std::size_t i = 0; i < half; ++i) {
    before += samples[i];
    after += samples[half + i];
  }
  for (std::size_t i = half; i + half < samples.size(); ++i) {
    steps[i] = static_cast<float>((after - before) / static_cast<double>(half));
    before += samples[i] - samples[i - half];
    after += samples[i + half] - samples[i];
  }
  return steps;
}

/// The largest step in one direction.
struct Edge {
  double delay_ms = 0;
  double step = 0;
};

/// The times around a toggle in which no other one can fall.
struct Window {
  double from_ns = 0, to_ns = 0;
};

Window window_of(std::span<const Toggle> toggles, std::size_t i) {
  const auto begin_of = [&](std::size_t k) { return static_cast<double>(toggles[k].begin_ns); };
  const double longest_ns = kLongestDelay_ms * 1e6, here = begin_of(i);
  Window window{here - longest_ns, here + longest_ns};
  if (i > 0) window.from_ns = std::max(window.from_ns, (begin_of(i - 1) + here) / 2);
  if (i + 1 < toggles.size()) window.to_ns = std::min(window.to_ns, (begin_of(i + 1) + here) / 2);
  return window;
}

/// The edge of a toggle; step 0 if the clip does not cover its window.
Edge edge_of(std::span<const Toggle> toggles, std::size_t i, const SoundClip& clip,
             std::span<const float> steps, bool is_inverted) {
  const auto window = window_of(toggles, i);
  const double first = std::ceil((window.from_ns - clip.first_ns) / clip.period_ns),
               last = std::floor((window.to_ns - clip.first_ns) / clip.period_ns);
  Edge edge;
  if (first < 0 || last < first || last >= static_cast<double>(steps.size())) return edge;
  const float sign = toggles[i].is_bright != is_inverted ? 1 : -1;
  for (auto k = static_cast<std::size_t>(first); k <= static_cast<std::size_t>(last); ++k)
    if (const double step = sign * steps[k]; step > edge.step) {
      // The step is between this sample and the one before it.
      const double at_ns = clip.first_ns + (static_cast<double>(k) - 0.5) * clip.period_ns;
      edge = {1e-6 * (at_ns - static_cast<double>(toggles[i].begin_ns)), step};
    }
  return edge;
}

std::vector<Edge> edges_of(std::span<const Toggle> toggles, const SoundClip& clip,
                           std::span<const float> steps, bool is_inverted) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < toggles.size(); ++i)
    if (toggles[i].is_sure)
      if (const auto edge = edge_of(toggles, i, clip, steps, is_inverted); edge.step > 0)
        edges.push_back(edge);
  return edges;
}

template <class Member>
double median_of(std::span<const Edge> edges, Member member) {
  std::vector<double> values;
  for (const auto& edge : edges) values.push_back(edge.*member);
  return median(std::move(values));
}

LightDelay with_interval(std::span<const Edge> edges, double error_ms) {
  constexpr int kResamples = 400;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, edges.size() - 1);
  std::vector<double> medians, sample(edges.size());
  for (int i = 0; i < kResamples; ++i) {
    for (auto& value : sample) value = edges[any(random)].delay_ms;
    medians.push_back(median(sample));
  }
  return {median_of(edges, &Edge::delay_ms), quantile(medians, 0.025) - error_ms,
          quantile(medians, 0.975) + error_ms, 0, 100 * median_of(edges, &Edge::step)};
}

double scatter_ms(std::span<const Edge> edges) {
  const double middle = median_of(edges, &Edge::delay_ms);
  std::vector<double> off;
  off.reserve(edges.size());
  for (const auto& edge : edges) off.push_back(std::abs(edge.delay_ms - middle));
  return median(std::move(off));
}

}  // namespace

Result<LightDelay> fit_sound_delay(std::span<const Toggle> toggles, const SoundClip& clip) {
  const auto steps = steps_of(clip);
  auto edges = edges_of(toggles, clip, steps, false);
  if (auto inverted = edges_of(toggles, clip, steps, true);
      median_of(inverted, &Edge::step) > median_of(edges, &Edge::step))
    edges = std::move(inverted);
  if (edges.size() < kLeastEdges)
    return fail(Errc::bad_data, fmt::format("{} changes of the light were recorded, and {} are "
                                            "needed",
                                            edges.size(), kLeastEdges));
  std::vector<double> sizes;
  for (const float step : steps) sizes.push_back(std::abs(step));
  const double noise = median(std::move(sizes)), step = median_of(edges, &Edge::step);
  if (step < kLeastStep || step < kLeastStepInNoise * noise)
    return fail(Errc::bad_data,
                fmt::format("the photodiode does not see the light: its signal steps by {:.2f} % "
                            "of full scale when the light changes, and by {:.2f} % at other times",
                            100 * step, 100 * noise));
  if (const double scatter = scatter_ms(edges); scatter > kMostScatter_ms)
    return fail(Errc::bad_data, fmt::format("the changes of the light come {:.0f} ms apart from "
                                            "each other, relative to the reported times",
                                            scatter));
  return with_interval(edges, 1e-6 * static_cast<double>(clip.error_ns));
}

}  // namespace handcast::calib
