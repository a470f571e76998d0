// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_palms.hpp"

#include <algorithm>
#include <cmath>

#include "services/landmarks/models/mediapipe_regions.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kSamePalm = 0.3f;  ///< least intersection over union
constexpr float kMostLogit = 100;

std::vector<glm::vec2> make_anchors() {
  std::vector<glm::vec2> anchors;
  for (const auto& [cells, per_cell] : {std::pair{24, 2}, {12, 6}})
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        anchors.insert(anchors.end(), per_cell,
                       (glm::vec2(x, y) + 0.5f) / static_cast<float>(cells));
  return anchors;
}

Palm decode(std::span<const float> values, glm::vec2 anchor, float logit) {
  const auto pair_at = [&](int i) {
    return glm::vec2(values[i], values[i + 1]) / static_cast<float>(kPalmSide_px);
  };
  Palm palm{1 / (1 + std::exp(-std::clamp(logit, -kMostLogit, kMostLogit))), anchor + pair_at(0),
            pair_at(2)};
  for (int k = 0; k < Palm::kPoints; ++k) palm.points[k] = anchor + pair_at(4 + 2 * k);
  return palm;
}

/// True if the palm has an extent and lies near the image, in units of its side. Written so that a
/// comparison with NaN refuses.
bool is_plausible(const Palm& palm) {
  constexpr float kFarthest = 100;
  const auto is_near = [](glm::vec2 at) {
    return std::abs(at.x) < kFarthest && std::abs(at.y) < kFarthest;
  };
  return palm.extent.x > 0 && palm.extent.y > 0 && is_near(palm.extent) && is_near(palm.centre) &&
         std::ranges::all_of(palm.points, is_near);
}

float overlap(const Palm& a, const Palm& b) {
  const glm::vec2 low = glm::max(a.centre - 0.5f * a.extent, b.centre - 0.5f * b.extent);
  const glm::vec2 high = glm::min(a.centre + 0.5f * a.extent, b.centre + 0.5f * b.extent);
  const glm::vec2 both = glm::max(high - low, glm::vec2(0));
  const float shared = both.x * both.y,
              all = a.extent.x * a.extent.y + b.extent.x * b.extent.y - shared;
  return all > 0 ? shared / all : 0;
}

/// The mean weighted by score, with the score of the first.
Palm merged(std::span<const Palm> same) {
  Palm mean{same.front().score};
  float weight = 0;
  for (const auto& palm : same) {
    weight += palm.score;
    mean.centre += palm.score * palm.centre;
    mean.extent += palm.score * palm.extent;
    for (int k = 0; k < Palm::kPoints; ++k) mean.points[k] += palm.score * palm.points[k];
  }
  mean.centre /= weight;
  mean.extent /= weight;
  for (auto& point : mean.points) point /= weight;
  return mean;
}

}  // namespace

std::span<const glm::vec2> palm_anchors() {
  static const std::vector<glm::vec2> kAnchors = make_anchors();
  return kAnchors;
}

std::vector<Palm> decode_palms(std::span<const float> boxes, std::span<const float> logits,
                               float least_score) {
  const auto anchors = palm_anchors();
  const float least_logit = std::log(least_score / (1 - least_score));
  std::vector<Palm> candidates;
  for (std::size_t i = 0; i < anchors.size() && i < logits.size(); ++i)
    if (logits[i] >= least_logit)
      candidates.push_back(
          decode(boxes.subspan(i * kPalmValues, kPalmValues), anchors[i], logits[i]));
  std::erase_if(candidates, [](const Palm& palm) { return !is_plausible(palm); });
  std::ranges::stable_sort(candidates, std::greater(), &Palm::score);

  std::vector<Palm> palms;
  while (!candidates.empty()) {
    const Palm best = candidates.front();
    const auto others =
        std::stable_partition(candidates.begin() + 1, candidates.end(),
                              [&](const Palm& palm) { return overlap(palm, best) > kSamePalm; });
    palms.push_back(merged({candidates.begin(), others}));
    candidates.erase(candidates.begin(), others);
  }
  return palms;
}

Region region_of_palm(const Palm& palm, const Region& shown) {
  const auto in_image = [&](glm::vec2 at) { return shown.to_image(at - 0.5f); };
  return mediapipe_region_of_palm(in_image(palm.centre), palm.extent * shown.size_px,
                                  in_image(palm.points[0]), in_image(palm.points[2]));
}

}  // namespace handcast::landmarks
