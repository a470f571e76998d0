// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/painter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/content/projegraphy/surface_pattern.hpp"

namespace handcast::projegraphy {
namespace {

constexpr int kSide = kPictureSide_px, kPer = kPictureSide_px / kMaskSide_px;
constexpr std::array<std::pair<int, int>, 19> kBones{{{1, 3},
                                                      {3, 4},
                                                      {4, 5},
                                                      {1, 7},
                                                      {7, 8},
                                                      {8, 9},
                                                      {9, 10},
                                                      {1, 12},
                                                      {12, 13},
                                                      {13, 14},
                                                      {14, 15},
                                                      {1, 17},
                                                      {17, 18},
                                                      {18, 19},
                                                      {19, 20},
                                                      {1, 22},
                                                      {22, 23},
                                                      {23, 24},
                                                      {24, 25}}};

glm::vec3 colour_of(std::uint32_t rgb) {
  return glm::vec3(rgb >> 16 & 0xff, rgb >> 8 & 0xff, rgb & 0xff) / 255.f;
}

/// The distance to a way between two points, and how far along it the nearest point is, 0..1.
struct Nearest {
  float distance, part;
};
Nearest nearest_on(const glm::vec2& a, const glm::vec2& b, const glm::vec2& at) {
  const glm::vec2 way = b - a;
  const float length2 = std::max(glm::dot(way, way), 1e-6f);
  const float part = std::clamp(glm::dot(at - a, way) / length2, 0.f, 1.f);
  return {glm::distance(at, a + part * way), part};
}

class Canvas {
 public:
  Canvas(const Silhouette& silhouette, const Recognised& recognised)
      : joints_(recognised.joints_px),
        unit_(recognised.unit_px * kPer),
        side_(recognised.is_mirrored ? -1.f : 1.f),
        depth_(kMaskSide_px, kMaskSide_px),
        along_(kMaskSide_px / 4, kMaskSide_px / 4),
        colour_(kSide, kSide) {
    for (auto& joint : joints_) joint = joint * static_cast<float>(kPer) + 0.5f;
    trunk_ = glm::normalize(joints_[12] - joints_[1] + 1e-6f);
    find_depth(silhouette);
    find_ways();
  }

  void cover(const Drawing& drawing) {
    const auto light = colour_of(drawing.light), dark = colour_of(drawing.dark);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        colour_.at(x, y) = glm::mix(dark, light, lightness(drawing.pattern, x, y));
  }
  void add(const Mark& mark);
  void shade();
  renderer::Texture texture() const;

 private:
  glm::vec2 place(const Spot& spot) const {
    const auto last = static_cast<int>(joints_.size()) - 1;
    const glm::vec2 a = joints_[static_cast<std::size_t>(std::min(spot.a, last))],
                    b = joints_[static_cast<std::size_t>(std::min(spot.b, last))], way = b - a;
    const float length = glm::length(way);
    const glm::vec2 beside = length > 1e-3f ? glm::vec2(-way.y, way.x) / length : glm::vec2(0);
    return a + spot.t * way + side_ * spot.side * unit_ * beside;
  }
  float lightness(Pattern pattern, int x, int y) const {
    const glm::vec2 at = (glm::vec2(x, y) - joints_[0]) / unit_;
    const bool is_local = pattern == Pattern::fur || pattern == Pattern::feathers;
    return std::clamp(lightness_of(pattern, at, is_local ? along(x, y) : trunk_), 0.f, 1.f);
  }
  /// The way of the bones there, interpolated.
  glm::vec2 along(int x, int y) const {
    const glm::vec2 at = glm::clamp(glm::vec2(x, y) / (4.f * kPer) - 0.5f, glm::vec2(0),
                                    glm::vec2(along_.width() - 1.01f, along_.height() - 1.01f));
    const glm::ivec2 cell(at);
    const glm::vec2 part = at - glm::vec2(cell);
    return glm::normalize(
        glm::mix(glm::mix(along_.at(cell.x, cell.y), along_.at(cell.x + 1, cell.y), part.x),
                 glm::mix(along_.at(cell.x, cell.y + 1), along_.at(cell.x + 1, cell.y + 1), part.x),
                 part.y) +
        1e-6f);
  }
  /// Calls `paint(at, colour)` for the pixels around a way.
  template <class Paint>
  void around(const glm::vec2& a, const glm::vec2& b, float radius, const Paint& paint) {
    const glm::ivec2 low(glm::max(glm::floor(glm::min(a, b) - radius), glm::vec2(0))),
        high(glm::min(glm::ceil(glm::max(a, b) + radius), glm::vec2(kSide - 1)));
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) paint(glm::vec2(x, y), colour_.at(x, y));
  }
  static void mix(glm::vec3& colour, const glm::vec3& with, float distance) {
    colour = glm::mix(colour, with, std::clamp(0.5f - distance, 0.f, 1.f));
  }
  void limb(const Mark& mark);
  void ball(const glm::vec2& at, float radius, const glm::vec3& colour);
  void eye(const Mark& mark);
  void line(const glm::vec2& a, const glm::vec2& by, const glm::vec2& b, float width,
            const glm::vec3& colour);
  void spiral(const Mark& mark);
  void find_depth(const Silhouette& silhouette);
  void find_ways();
  float depth_at(int x, int y) const {
    return depth_.at(std::clamp(x, 0, kMaskSide_px - 1), std::clamp(y, 0, kMaskSide_px - 1));
  }

  std::vector<glm::vec2> joints_;
  float unit_, side_;
  glm::vec2 trunk_{0, -1};            ///< from the wrist to the knuckles of the first hand
  renderer::Image<float> depth_;      ///< of the mask: how far inside, px
  renderer::Image<glm::vec2> along_;  ///< the way of the nearest bones
  renderer::Image<glm::vec3> colour_;
};

void Canvas::find_depth(const Silhouette& silhouette) {
  constexpr float kSide_px = 1, kDiagonal_px = 4.f / 3;
  for (std::size_t i = 0; i < depth_.pixels().size(); ++i)
    depth_.pixels()[i] = silhouette.skin.pixels()[i] ? 1e3f : 0.f;
  const auto nearer = [&](int x, int y, int dx, int dy) {
    depth_.at(x, y) = std::min(
        depth_.at(x, y), depth_at(x + dx, y + dy) + (dx != 0 && dy != 0 ? kDiagonal_px : kSide_px));
  };
  for (int y = 0; y < kMaskSide_px; ++y)
    for (int x = 0; x < kMaskSide_px; ++x)
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}})
        nearer(x, y, dx, dy);
  for (int y = kMaskSide_px - 1; y >= 0; --y)
    for (int x = kMaskSide_px - 1; x >= 0; --x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}}) nearer(x, y, dx, dy);
}

void Canvas::find_ways() {
  for (int y = 0; y < along_.height(); ++y)
    for (int x = 0; x < along_.width(); ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) * static_cast<float>(4 * kPer);
      glm::vec2 sum(1e-6f, 0);
      for (std::size_t hand = 0; hand + 25 < joints_.size(); hand += 26)
        for (const auto& [from, to] : kBones) {
          const glm::vec2 a = joints_[hand + static_cast<std::size_t>(from)],
                          b = joints_[hand + static_cast<std::size_t>(to)];
          const float length = glm::distance(a, b);
          if (length < 1) continue;
          const float near = 1 / (0.02f * unit_ + nearest_on(a, b, at).distance);
          sum += near * near * near * (b - a) / length;
        }
      along_.at(x, y) = glm::normalize(sum);
    }
}

void Canvas::limb(const Mark& mark) {
  const glm::vec2 a = place(mark.from), b = place(mark.to);
  const auto colour = colour_of(mark.colour);
  const float r0 = mark.r0 * unit_, r1 = mark.r1 * unit_, ink = 0.012f * unit_;
  around(a, b, std::max(r0, r1) + 2, [&](const glm::vec2& at, glm::vec3& under) {
    const auto nearest = nearest_on(a, b, at);
    const float distance = nearest.distance - std::lerp(r0, r1, nearest.part);
    if (distance > 1) return;
    const float light = lightness(mark.pattern, static_cast<int>(at.x), static_cast<int>(at.y));
    const float edge = 0.5f + 0.5f * std::clamp(-distance / ink, 0.f, 1.f);
    mix(under, colour * (0.45f + 0.55f * light) * edge, distance);
  });
}

void Canvas::ball(const glm::vec2& at, float radius, const glm::vec3& colour) {
  around(at, at, radius + 2, [&](const glm::vec2& here, glm::vec3& under) {
    const glm::vec2 way = (here - at) / radius;
    const float distance = glm::distance(here, at) - radius,
                shine = std::exp(
                    -12 * glm::dot(way + glm::vec2(0.35f, 0.4f), way + glm::vec2(0.35f, 0.4f)));
    const float round = 1 - 0.45f * std::clamp(glm::dot(way, way), 0.f, 1.f);
    mix(under, glm::min(colour * round + 0.6f * shine, 1.f), distance);
  });
}

void Canvas::eye(const Mark& mark) {
  const glm::vec2 at = place(mark.from);
  const float radius = mark.r0 * unit_;
  const bool is_slit = mark.kind == Mark::Kind::slit;
  const auto iris = colour_of(mark.colour);
  around(at, at, radius * 1.2f + 2, [&](const glm::vec2& here, glm::vec3& under) {
    const float distance = glm::distance(here, at);
    const glm::vec2 way = (here - at) / radius;
    mix(under, glm::vec3(0.04f), distance - 1.14f * radius);
    mix(under, is_slit ? iris : glm::vec3(1), distance - radius);
    if (!is_slit) mix(under, iris, distance - 0.7f * radius);
    const float pupil =
        is_slit ? std::hypot(way.x * 3.2f, way.y) - 0.85f : glm::length(way) - 0.42f;
    mix(under, glm::vec3(0.02f), pupil * radius);
    mix(under, glm::vec3(1), glm::distance(way, {-0.28f, -0.32f}) * radius - 0.2f * radius);
  });
}

void Canvas::line(const glm::vec2& a, const glm::vec2& by, const glm::vec2& b, float width,
                  const glm::vec3& colour) {
  constexpr int kPieces = 12;
  std::array<glm::vec2, kPieces + 1> points;
  glm::vec2 low(1e6f), high(-1e6f);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float t = static_cast<float>(i) / kPieces, s = 1 - t;
    points[i] = s * s * a + 2 * s * t * by + t * t * b;
    low = glm::min(low, points[i]);
    high = glm::max(high, points[i]);
  }
  around(low, high, width + 2, [&](const glm::vec2& at, glm::vec3& under) {
    float nearest = 1e6f;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      nearest = std::min(nearest, nearest_on(points[i], points[i + 1], at).distance);
    mix(under, colour, nearest - 0.5f * width);
  });
}

void Canvas::spiral(const Mark& mark) {
  constexpr int kPieces = 36;
  constexpr float kTurns = 2.6f;
  const glm::vec2 middle = place(mark.from);
  const auto on = [&](float t) {
    const float angle = kTurns * 2 * std::numbers::pi_v<float> * t;
    return middle + mark.r0 * unit_ * t * glm::vec2(side_ * std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < kPieces; ++i) {
    const float t = static_cast<float>(i) / kPieces, next = static_cast<float>(i + 1) / kPieces;
    line(on(t), on(0.5f * (t + next)), on(next), 0.045f * unit_, colour_of(mark.colour));
  }
}

void Canvas::add(const Mark& mark) {
  switch (mark.kind) {
    case Mark::Kind::limb:
      return limb(mark);
    case Mark::Kind::eye:
    case Mark::Kind::slit:
      return eye(mark);
    case Mark::Kind::disc:
      return ball(place(mark.from), mark.r0 * unit_, colour_of(mark.colour));
    case Mark::Kind::line:
      return line(place(mark.from), place(mark.by), place(mark.to), mark.r0 * unit_,
                  colour_of(mark.colour));
    case Mark::Kind::spiral:
      return spiral(mark);
  }
}

/// Makes the surface round, with light from the upper left, and darkens the outline.
void Canvas::shade() {
  const float round_px = 0.16f * unit_ / kPer, ink_px = 0.03f * unit_ / kPer;
  renderer::Image<float> light(kMaskSide_px, kMaskSide_px, 1);
  for (int y = 0; y < kMaskSide_px; ++y)
    for (int x = 0; x < kMaskSide_px; ++x) {
      constexpr int kStep = 3;
      const float depth = depth_.at(x, y);
      if (depth <= 0) continue;
      const glm::vec2 slope(depth_at(x + kStep, y) - depth_at(x - kStep, y),
                            depth_at(x, y + kStep) - depth_at(x, y - kStep));
      const float part = std::clamp(depth / round_px, 0.f, 1.f);
      const float tilt = glm::dot(slope, glm::vec2(0.5f, 0.86f)) / (2 * kStep) * (1 - part);
      light.at(x, y) = (0.8f + 0.2f * part + 0.35f * tilt) *
                       (0.45f + 0.55f * std::clamp(depth / ink_px, 0.f, 1.f));
    }
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int u = std::min(x / kPer, kMaskSide_px - 2), v = std::min(y / kPer, kMaskSide_px - 2);
      const float right = static_cast<float>(x % kPer) / kPer,
                  below = static_cast<float>(y % kPer) / kPer;
      const float level =
          std::lerp(std::lerp(light.at(u, v), light.at(u + 1, v), right),
                    std::lerp(light.at(u, v + 1), light.at(u + 1, v + 1), right), below);
      colour_.at(x, y) = glm::clamp(colour_.at(x, y) * level, 0.f, 1.f);
    }
}

renderer::Texture Canvas::texture() const {
  renderer::Texture texture(kSide, kSide);
  for (std::size_t i = 0; i < colour_.pixels().size(); ++i) {
    const glm::vec3 level = glm::clamp(colour_.pixels()[i], 0.f, 1.f) * 255.f + 0.5f;
    texture.pixels()[i] = 0xff000000u | static_cast<std::uint32_t>(level.b) << 16 |
                          static_cast<std::uint32_t>(level.g) << 8 |
                          static_cast<std::uint32_t>(level.r);
  }
  return texture;
}

}  // namespace

renderer::Texture painted(const Silhouette& silhouette, const Recognised& recognised) {
  const auto& drawing = drawings()[static_cast<std::size_t>(recognised.animal)];
  Canvas canvas(silhouette, recognised);
  canvas.cover(drawing);
  for (const auto& mark : drawing.marks)
    if (mark.kind == Mark::Kind::limb) canvas.add(mark);
  canvas.shade();
  for (const auto& mark : drawing.marks)
    if (mark.kind != Mark::Kind::limb) canvas.add(mark);
  return canvas.texture();
}

renderer::Texture calm_picture() {
  const glm::vec3 night = colour_of(0x12355b), sea = colour_of(0x1f7a7d),
                  dusk = colour_of(0x7a5c99);
  renderer::Texture picture(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::vec2 at = glm::vec2(x, y) * (2 * std::numbers::pi_v<float> / kSide);
      const float tide = 0.5f + 0.5f * std::sin(at.y + 0.6f * std::sin(1.3f * at.x)),
                  swell = 0.5f + 0.5f * std::sin(3 * at.y + std::sin(2 * at.x + 1));
      const glm::vec3 colour = 255.f * glm::mix(glm::mix(night, sea, tide), dusk, 0.5f * swell);
      picture.at(x, y) = 0xff000000u | static_cast<std::uint32_t>(colour.b) << 16 |
                         static_cast<std::uint32_t>(colour.g) << 8 |
                         static_cast<std::uint32_t>(colour.r);
    }
  return picture;
}

}  // namespace handcast::projegraphy
