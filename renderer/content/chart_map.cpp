// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/chart_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/content/chart_raster.hpp"
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
    leader_ = find_leader();
  }

  /// The joint with the largest weight at a point of the triangle; the first one if several have
  /// it.
  std::uint8_t strongest(const Parts& part) const {
    return joints_[leader_ >= 0 ? leader_ : strongest_place(part)];
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

  int strongest_place(const Parts& part) const {
    std::array<double, 12> weight{};
    for (int s = 0; s < share_count_; ++s)
      weight[shares_[s].place] += part[shares_[s].corner] * shares_[s].weight;
    return static_cast<int>(std::max_element(weight.begin(), weight.begin() + joint_count_) -
                            weight.begin());
  }

  /// The joint that is the strongest one at all three corners, and so everywhere between them; -1
  /// if there is none, or if its lead is so small that rounding could decide.
  int find_leader() const {
    constexpr double kLead = 1e-6;
    const int leader = strongest_place({1, 0, 0});
    for (int k = 0; k < 3; ++k) {
      std::array<double, 12> weight{};
      for (int s = 0; s < share_count_; ++s)
        if (shares_[s].corner == k) weight[shares_[s].place] += shares_[s].weight;
      for (int place = 0; place < joint_count_; ++place)
        if (place != leader && weight[leader] < weight[place] + kLead) return -1;
    }
    return leader;
  }

  std::array<std::uint8_t, 12> joints_{};  ///< those with a weight, ascending
  std::array<Share, 12> shares_{};
  int joint_count_ = 0, share_count_ = 0;
  int leader_ = -1;  ///< find_leader(): index into joints_
};

}  // namespace

ChartMap::ChartMap(const HandMesh& hand, int width, int height)
    : texels_(width, height), on_(width, height), off_(width, height, 1) {
  for (const auto& triangle : hand.triangles) draw_triangle(hand, triangle);
  std::array<double, 256> outwards{};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    outwards[hand.chart[v]] += glm::dot(hand.normals[v], glm::vec3(hand.rest[1][1]));
  for (std::size_t chart = 0; chart < outwards.size(); ++chart)
    facing_[chart] = outwards[chart] < 0 ? -1.f : 1.f;
  measure_edges();
}

void ChartMap::draw_triangle(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners) {
  const JointShares shares(hand, corners);
  const std::uint8_t chart = hand.chart[corners[0]];
  for_each_texel(
      hand, corners, texels_.width(), texels_.height(), [&](int x, int y, const Parts& parts) {
        glm::vec3 rest_mm{0};
        for (std::size_t k = 0; k < 3; ++k)
          rest_mm += 1000.f * static_cast<float>(parts[k]) * hand.positions[corners[k]];
        rest_mm = in_wrist_mm(hand, rest_mm);
        texels_.at(x, y) = {chart, shares.strongest(parts), kEdgeReach, {rest_mm.x, rest_mm.z}};
        on_.at(x, y) = 1;
        off_.at(x, y) = 0;
      });
}

void ChartMap::measure_edges() {
  cpu::NearestPixel nearest;
  for (const auto& way :
       nearest.find(std::as_const(off_).view(), std::as_const(on_).view(), kEdgeReach))
    texels_.at(way.x, way.y).edge_px = static_cast<std::uint8_t>(std::sqrt(way.squared_px));
}

void ChartMap::pad(Texture& texture) const {
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(on_.view(), off_.view(), cpu::NearestPixel::kLargestReach))
    texture.at(way.x, way.y) = texture.at(way.x + way.dx, way.y + way.dy);
}

}  // namespace handcast::renderer
