// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_palms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/landmarks/models/mediapipe_files.hpp"

namespace handcast::landmarks {
namespace {

constexpr std::array kPalmAndMiddleJoints{0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
constexpr float kLandmarkScale = 2.0f, kLandmarkShift = -0.1f;
constexpr float kPalmScale = 2.6f, kPalmShift = -0.5f;

/// The region's angle at which `from` to `to` points up.
float angle_of(glm::vec2 from, glm::vec2 to) { return std::atan2(to.x - from.x, from.y - to.y); }

/// Shifts the box along its own vertical by a share of its height and makes it a square, `scale`
/// times its longer side.
Region square_of(glm::vec2 centre_px, glm::vec2 extent_px, float angle_rad, float scale,
                 float shift) {
  const glm::vec2 moved = centre_px + turned({0, shift * extent_px.y}, angle_rad);
  return {moved, scale * std::max(extent_px.x, extent_px.y), angle_rad};
}

}  // namespace

Region mediapipe_region_of_landmarks(const Points& points_px) {
  const glm::vec2 knuckles = 0.25f * (points_px[5] + points_px[13]) + 0.5f * points_px[9];
  const float angle_rad = angle_of(points_px[0], knuckles);
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const int i : kPalmAndMiddleJoints) {
    const glm::vec2 upright = turned(points_px[i], -angle_rad);
    low = glm::min(low, upright);
    high = glm::max(high, upright);
  }
  return square_of(turned(0.5f * (low + high), angle_rad), high - low, angle_rad, kLandmarkScale,
                   kLandmarkShift);
}

Region mediapipe_region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                                glm::vec2 middle_knuckle_px) {
  return square_of(centre_px, extent_px, angle_of(wrist_px, middle_knuckle_px), kPalmScale,
                   kPalmShift);
}

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

Result<MediapipePalmNetwork> MediapipePalmNetwork::open(const std::filesystem::path& file) {
  static const NetworkShapes kShapes{"the palm network",
                                     {1, kPalmSide_px, kPalmSide_px, 3},
                                     {{1, kPalmAnchors, kPalmValues}, {1, kPalmAnchors, 1}}};
  auto network = open_mediapipe_network(file, kShapes);
  if (!network) return tl::make_unexpected(network.error());
  return MediapipePalmNetwork(std::move(*network));
}

Result<std::vector<Region>> MediapipePalmNetwork::search(renderer::GreyView image) {
  const Region whole = region_of_image(image.width, image.height);
  crop_.cut(image, whole);
  crop_.write_rgb(network_->input(0));
  if (const auto done = network_->run(); !done) return tl::make_unexpected(done.error());
  std::vector<Region> regions;
  for (const auto& palm : decode_palms(network_->output(0), network_->output(1)))
    regions.push_back(region_of_palm(palm, whole));
  return regions;
}

}  // namespace handcast::landmarks
