// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/chart_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::renderer {
namespace {

using Parts = std::array<double, 3>;  ///< barycentric coordinates

/// The skin weights of a triangle, by joint.
class JointShares {
 public:
  JointShares(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners) {
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 4; ++i)
        if (hand.weights[corners[k]][i] > 0) note(hand.joints[corners[k]][i]);
    std::sort(joints_.begin(), joints_.begin() + joint_count_);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 4; ++i)
        if (const double weight = hand.weights[corners[k]][i]; weight > 0)
          shares_[share_count_++] = {place_of(hand.joints[corners[k]][i]), k, weight};
  }

  /// The joint with the largest weight at a point of the triangle; the first one if several have
  /// it.
  std::uint8_t strongest(const Parts& part) const {
    if (joint_count_ == 1) return joints_[0];
    std::array<double, 12> weight{};
    for (int s = 0; s < share_count_; ++s)
      weight[shares_[s].place] += part[shares_[s].corner] * shares_[s].weight;
    return joints_[std::max_element(weight.begin(), weight.begin() + joint_count_) -
                   weight.begin()];
  }

 private:
  struct Share {
    int place;  ///< index into joints_
    int corner;
    double weight;
  };

  void note(std::uint8_t joint) {
    const auto end = joints_.begin() + joint_count_;
    if (std::find(joints_.begin(), end, joint) == end) joints_[joint_count_++] = joint;
  }
  int place_of(std::uint8_t joint) const {
    return static_cast<int>(std::find(joints_.begin(), joints_.end(), joint) - joints_.begin());
  }

  std::array<std::uint8_t, 12> joints_{};  ///< those with a weight, ascending
  std::array<Share, 12> shares_{};
  int joint_count_ = 0, share_count_ = 0;
};

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

ChartMap::ChartMap(const HandMesh& hand, int width, int height) : texels_(width, height) {
  for (const auto& triangle : hand.triangles) draw_triangle(hand, triangle);
  std::array<double, 256> outwards{};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    outwards[hand.chart[v]] += hand.normals[v].y;
  for (std::size_t chart = 0; chart < outwards.size(); ++chart)
    facing_[chart] = outwards[chart] < 0 ? -1.f : 1.f;
  measure_edges();
}

void ChartMap::draw_triangle(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners) {
  const glm::dvec2 size(texels_.width(), texels_.height());
  std::array<glm::dvec2, 3> at;  // in texels, whole numbers at texel centres
  for (int k = 0; k < 3; ++k) at[k] = glm::dvec2(hand.uv[corners[k]]) * size - 0.5;
  const double area = cross(at[1] - at[0], at[2] - at[0]);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                   high = glm::max(at[0], glm::max(at[1], at[2]));
  const Rect box =
      Rect{static_cast<int>(std::ceil(low.x)), static_cast<int>(std::ceil(low.y)),
           static_cast<int>(std::floor(high.x)) + 1, static_cast<int>(std::floor(high.y)) + 1}
          .within(texels_.width(), texels_.height());
  const JointShares shares(hand, corners);
  constexpr double kSlack = 1e-9;  // texels on a shared edge may be drawn twice, but not missed
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const glm::dvec2 p(x, y);
      const Parts part{cross(at[2] - at[1], p - at[1]) / area,
                       cross(at[0] - at[2], p - at[2]) / area,
                       cross(at[1] - at[0], p - at[0]) / area};
      if (std::min({part[0], part[1], part[2]}) < -kSlack) continue;
      ChartTexel& texel = texels_.at(x, y);
      texel.chart = hand.chart[corners[0]];
      texel.joint = shares.strongest(part);
      texel.rest_mm = glm::vec3{0};
      for (int k = 0; k < 3; ++k)
        texel.rest_mm += 1000.f * static_cast<float>(part[k]) * hand.positions[corners[k]];
    }
  }
}

void ChartMap::measure_edges() {
  Image<std::uint8_t> on(texels_.width(), texels_.height()), off = on;
  for (int y = 0; y < on.height(); ++y) {
    for (int x = 0; x < on.width(); ++x) {
      const bool covered = texels_.at(x, y).chart != 0;
      on.at(x, y) = covered;
      off.at(x, y) = !covered;
      texels_.at(x, y).edge_px = kEdgeReach;
    }
  }
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(std::as_const(off).view(), std::as_const(on).view(),
                                      kEdgeReach)) {
    texels_.at(way.x, way.y).edge_px = static_cast<std::uint8_t>(std::sqrt(way.squared_px));
  }
}

void ChartMap::pad(Image<glm::vec3>& colours) const {
  Image<std::uint8_t> on(texels_.width(), texels_.height()), off = on;
  for (int y = 0; y < on.height(); ++y) {
    for (int x = 0; x < on.width(); ++x) (texels_.at(x, y).chart != 0 ? on : off).at(x, y) = 1;
  }
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(std::as_const(on).view(), std::as_const(off).view(),
                                      cpu::NearestPixel::kLargestReach)) {
    colours.at(way.x, way.y) = colours.at(way.x + way.dx, way.y + way.dy);
  }
}

}  // namespace handcast::renderer
