// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/mask/threshold.hpp"
#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::landmarks {
namespace {

constexpr int kShrink = 4;
constexpr std::size_t kMostParts = 2;
constexpr double kLeastShare = 0.004;  ///< least area of a part, as a share of the image
constexpr int kLeastEdge = 3;          ///< pixels at the edge of the image that make an arm
constexpr float kLeastPalm = 0.4f;     ///< radius, as a share of that of the widest place
// The region of an open hand, in radii of the circle in its palm.
constexpr float kSide = 5.5f, kTowardsFingers = 0.8f;

glm::vec2 mean_of(std::span<const glm::ivec2> pixels) {
  glm::vec2 sum(0);
  for (const glm::ivec2 pixel : pixels) sum += pixel;
  return sum / static_cast<float>(pixels.size());
}

/// The direction in which the pixels spread most, unit.
glm::vec2 long_axis(std::span<const glm::ivec2> pixels) {
  const glm::vec2 centre = mean_of(pixels);
  float xx = 0, xy = 0, yy = 0;
  for (const glm::ivec2 pixel : pixels) {
    const glm::vec2 off = glm::vec2(pixel) - centre;
    xx += off.x * off.x, xy += off.x * off.y, yy += off.y * off.y;
  }
  const float angle = 0.5f * std::atan2(2 * xy, xx - yy);
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

std::span<const BrightHand> BrightHands::search(renderer::GreyView image,
                                                std::span<const Points> known, int places) {
  found_.clear();
  const auto small = smaller_.shrink(image, {0, 0, image.width, image.height}, kShrink);
  const renderer::Rect all{0, 0, small.width, small.height};
  const int threshold = all.empty() ? 0 : renderer::choose_threshold(small, all);
  if (threshold == 0) return found_;
  bright_ = renderer::Image<std::uint8_t>(small.width, small.height);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) bright_.at(x, y) = small.at(x, y) > threshold ? 255 : 0;
  runs_.build(bright_.view(), all);
  for (const int root : largest_parts(known)) {
    const Part part = read(root);
    for (const Circle& circle : widest_places(part, places)) found_.push_back(around(part, circle));
  }
  return found_;
}

/// The roots of the largest parts that are not known hands.
std::vector<int> BrightHands::largest_parts(std::span<const Points> known) {
  std::vector<int> excluded, roots;
  for (const Points& hand : known)
    for (const glm::vec2 point : hand)
      if (is_finite(hand))
        excluded.push_back(runs_.part_at(static_cast<int>(point.x) / kShrink,
                                         static_cast<int>(point.y) / kShrink));
  const double least = kLeastShare * bright_.width() * bright_.height();
  for (int i = 0; i < static_cast<int>(runs_.runs().size()); ++i) {
    const auto& run = runs_.runs()[i];
    if (runs_.part_of(run) == i && run.area >= least && !std::ranges::count(excluded, i))
      roots.push_back(i);
  }
  std::ranges::sort(roots,
                    [&](int a, int b) { return runs_.runs()[a].area > runs_.runs()[b].area; });
  if (roots.size() > kMostParts) roots.resize(kMostParts);
  return roots;
}

BrightHands::Part BrightHands::read(int root) {
  Part part;
  for (const auto& run : runs_.runs()) {
    if (runs_.part_of(run) != root) continue;
    for (int x = run.x0; x < run.x1; ++x) {
      part.pixels.emplace_back(x, run.y);
      const bool at_edge =
          x == 0 || run.y == 0 || x == bright_.width() - 1 || run.y == bright_.height() - 1;
      if (!at_edge) continue;
      part.at_edge += glm::vec2(x, run.y);
      ++part.edge_pixels;
    }
  }
  if (part.edge_pixels > 0) part.at_edge /= static_cast<float>(part.edge_pixels);
  return part;
}

/// The pixels of the part that are farthest from the dark, by a chamfer distance transform
/// (Borgefors 1986, weights 3 and 4), each beside the circles of those before. Beyond the edge of
/// the image the part is taken to go on.
std::vector<BrightHands::Circle> BrightHands::widest_places(const Part& part, int most) {
  constexpr std::uint16_t kFar = 60000;
  inside_ = renderer::Image<std::uint16_t>(bright_.width(), bright_.height());
  for (const glm::ivec2 pixel : part.pixels) inside_.at(pixel.x, pixel.y) = kFar;
  const auto relax = [&](int x, int y, int step) {
    auto& here = inside_.at(x, y);
    const auto at_most = [&](int nx, int ny, int cost) {
      if (nx < 0 || ny < 0 || nx >= inside_.width() || ny >= inside_.height()) return;
      here = static_cast<std::uint16_t>(std::min<int>(here, inside_.at(nx, ny) + cost));
    };
    at_most(x - step, y, 3), at_most(x, y - step, 3);
    at_most(x - step, y - step, 4), at_most(x + step, y - step, 4);
  };
  for (const glm::ivec2 pixel : part.pixels) relax(pixel.x, pixel.y, 1);
  for (auto pixel = part.pixels.rbegin(); pixel != part.pixels.rend(); ++pixel)
    relax(pixel->x, pixel->y, -1);
  std::vector<Circle> circles;
  while (static_cast<int>(circles.size()) < most) {
    Circle widest{glm::vec2(0), 0};
    for (auto pixel = part.pixels.rbegin(); pixel != part.pixels.rend(); ++pixel) {
      const float radius = static_cast<float>(inside_.at(pixel->x, pixel->y)) / 3;
      const bool is_beside = std::ranges::all_of(circles, [&](const Circle& other) {
        return glm::distance(glm::vec2(*pixel), other.centre) > other.radius;
      });
      if (radius > widest.radius && is_beside) widest = {glm::vec2(*pixel), radius};
    }
    if (!circles.empty() && widest.radius < kLeastPalm * circles.front().radius) break;
    circles.push_back(widest);
  }
  return circles;
}

BrightHand BrightHands::around(const Part& part, const Circle& palm) const {
  glm::vec2 up = long_axis(part.pixels);
  if (part.edge_pixels >= kLeastEdge && glm::distance(palm.centre, part.at_edge) > palm.radius)
    up = glm::normalize(palm.centre - part.at_edge);
  else if (up.y > 0)
    up = -up;
  // The likely direction, its opposite, then the others in between, the nearer ones first.
  constexpr std::array kEighths{0, 1, -1, 4, 2, -2, 3, -3};
  BrightHand hand;
  for (int i = 0; i < BrightHand::kDirections; ++i) {
    const glm::vec2 direction =
        turned(up, static_cast<float>(kEighths[i]) * std::numbers::pi_v<float> / 4);
    const glm::vec2 centre = palm.centre + kTowardsFingers * palm.radius * direction;
    hand.regions[i] = {(centre + 0.5f) * static_cast<float>(kShrink) - 0.5f,
                       kSide * palm.radius * kShrink, std::atan2(direction.x, -direction.y)};
  }
  return hand;
}

}  // namespace handcast::landmarks
