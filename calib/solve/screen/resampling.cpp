// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr int kFolds = 5, kSamples = 200;
constexpr int kLeastViews = 5;  ///< fewer are too few to sample from
constexpr double kNormal95 = 1.96;

/// Neighbours in x and in y differ.
int fold_of(int block) { return (block % kBlocksAcross + 2 * (block / kBlocksAcross)) % kFolds; }

/// The blocks that hold observations, by views.
std::vector<std::vector<int>> filled_blocks(std::span<const Observation> observations, int views) {
  std::vector<std::vector<int>> filled(static_cast<std::size_t>(views));
  for (const auto& observation : observations)
    filled[static_cast<std::size_t>(observation.block / kImageBlocks)].push_back(observation.block);
  for (auto& blocks : filled) {
    std::ranges::sort(blocks);
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  }
  std::erase_if(filled, [](const auto& blocks) { return blocks.empty(); });
  return filled;
}

}  // namespace

ErrorsPx errors_of(const std::vector<double>& residuals_px) {
  return {median(residuals_px), quantile(residuals_px, 0.95)};
}

ErrorsPx errors_of(const ProjectorModel& model, std::span<const Observation> observations) {
  std::vector<double> residuals_px;
  for (const auto& observation : observations)
    residuals_px.push_back(residual_px(model, observation));
  return errors_of(residuals_px);
}

std::vector<double> held_out_by_blocks(const Replicas& replicas,
                                       std::span<const Observation> observations, int views) {
  std::vector<double> residuals_px;
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<double> weights(static_cast<std::size_t>(views * kImageBlocks));
    for (int block = 0; block < views * kImageBlocks; ++block)
      weights[static_cast<std::size_t>(block)] = fold_of(block % kImageBlocks) != fold;
    const auto model = replicas.with_weights(weights);
    if (!model) continue;
    for (const auto& observation : observations)
      if (fold_of(observation.block % kImageBlocks) == fold)
        residuals_px.push_back(residual_px(*model, observation));
  }
  return residuals_px;
}

std::array<glm::dvec2, 4> corners_in_camera(const ProjectorModel& model,
                                            const glm::ivec2& projector_px) {
  const auto back = glm::inverse(model.from_camera);
  const glm::dvec2 last = projector_px - 1;
  return {mapped(back, {0, 0}), mapped(back, {last.x, 0}), mapped(back, last),
          mapped(back, {0, last.y})};
}

Bootstrap::Bootstrap(const Replicas& replicas, std::span<const Observation> observations, int views,
                     Unknowns unknowns) {
  const auto filled = filled_blocks(observations, views);
  int blocks = 0;
  for (const auto& of_view : filled) blocks += static_cast<int>(of_view.size());
  widening_ = std::sqrt(blocks / std::max(1., blocks - static_cast<double>(unknowns)));
  std::mt19937 random(1);
  for (int sample = 0; sample < kSamples; ++sample) {
    std::vector<double> weights(static_cast<std::size_t>(views * kImageBlocks));
    for (std::size_t i = 0; i < filled.size(); ++i) {
      const auto& of_view = views >= kLeastViews ? filled[random() % filled.size()] : filled[i];
      for (std::size_t j = 0; j < of_view.size(); ++j)
        weights[static_cast<std::size_t>(of_view[random() % of_view.size()])] += 1;
    }
    if (const auto model = replicas.with_weights(weights)) models_.push_back(*model);
  }
}

double Bootstrap::interval(const std::function<double(const ProjectorModel&)>& value) const {
  const auto count = static_cast<double>(models_.size());
  if (count < 2) return std::numeric_limits<double>::infinity();
  std::vector<double> values;
  for (const auto& model : models_) values.push_back(value(model));
  const double mean = std::accumulate(values.begin(), values.end(), 0.) / count;
  double square = 0;
  for (const double one : values) square += (one - mean) * (one - mean);
  return kNormal95 * widening_ * std::sqrt(square / (count - 1));
}

std::array<glm::dvec2, 4> Bootstrap::corner_intervals(const glm::ivec2& projector_px) const {
  std::array<glm::dvec2, 4> intervals;
  for (std::size_t corner = 0; corner < 4; ++corner)
    for (int axis = 0; axis < 2; ++axis)
      intervals[corner][axis] = interval([&](const ProjectorModel& model) {
        return corners_in_camera(model, projector_px)[corner][axis];
      });
  return intervals;
}

}  // namespace handcast::calib
