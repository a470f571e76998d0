// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "renderer/skin/skinning.hpp"
#include "services/evaluation/twin/surface.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::twin {
namespace {

using msg::kJoints;
using renderer::HandMesh;
using renderer::Rect;

constexpr int kWrist = 1;
constexpr float kArmBegins_m = 0.005f;  ///< behind the wrist
/// Velocities are central differences over this time before and after the light.
constexpr std::int64_t kVelocityStep_ns = 1'000'000;

/// The surface at a projector pixel: kNothing, kArm, or a triangle of a hand.
using Surface = std::uint32_t;
constexpr Surface kNothing = 0, kArm = 1, kFirstTriangle = 2;
constexpr Surface surface_of(std::size_t hand, std::size_t triangle) {
  return kFirstTriangle + static_cast<Surface>(hand << 16 | triangle);
}
constexpr std::size_t hand_of(Surface surface) { return (surface - kFirstTriangle) >> 16; }
constexpr std::size_t triangle_of(Surface surface) { return (surface - kFirstTriangle) & 0xffff; }

/// A true hand seen from the projector at the time of the light.
struct SeenHand {
  Side side = Side::left;
  const HandMesh* mesh = nullptr;
  const std::vector<float>* behind_wrist_m = nullptr;
  const Forearm* forearm = nullptr;
  ScreenVertices screen, arm;
  std::vector<glm::vec2> velocity_px_s;
  std::vector<glm::vec3> velocity_m_s;
  std::array<glm::vec2, kJoints> joints_px;
};

int spill_in(const Surface* surface, const std::uint8_t* lit, int count) {
  int spill = 0;
  for (int x = 0; x < count; ++x) spill += surface[x] == kNothing ? lit[x] : 0;
  return spill;
}

/// The lit pixels of one projection.
class Light {
 public:
  explicit Light(const msg::Projection& projection)
      : pixels_(projection.pixels()),
        x_(projection.region_x_px),
        y_(projection.region_y_px),
        width_(static_cast<int>(projection.region_width_px)),
        height_(static_cast<int>(projection.region_height_px)) {}

  Rect region() const { return {x_, y_, x_ + width_, y_ + height_}; }
  /// Writes lit[x0 .. x1) of row y of the projector: 1 if at least half of the pixel
  /// is lit, else 0.
  void row(int y, int x0, int x1, std::uint8_t* lit) const {
    std::fill(lit + x0, lit + x1, std::uint8_t{0});
    if (y < y_ || y >= y_ + height_) return;
    const int first = std::max(x0, x_), last = std::min(x1, x_ + width_);
    const std::uint32_t* pixels = pixels_ + static_cast<std::ptrdiff_t>(y - y_) * width_ - x_;
    for (int x = first; x < last; ++x) lit[x] = pixels[x] >> 24 >= 128;
  }

 private:
  const std::uint32_t* pixels_;
  int x_, y_, width_, height_;
};

class RigJudge final : public Judge {
 public:
  RigJudge(const Twin& twin, const calib::Calibration& calibration, int step_px)
      : twin_(twin),
        step_px_(std::max(step_px, 1)),
        camera_from_tracker_(calibration.camera_from_tracker),
        projector_from_space_(calibration.projector_from_camera * calibration.camera.matrix()),
        mm_per_px_at_1_m_(static_cast<float>(calibration.mm_per_projector_px(1))),
        surface_(calibration.projector_width_px, calibration.projector_height_px),
        inverse_depth_(calibration.projector_width_px, calibration.projector_height_px),
        lit_(calibration.projector_width_px, calibration.projector_height_px) {
    const glm::dmat2 map(calibration.projector_from_camera);
    // A homography that mirrors reverses the orientation of the triangles.
    front_ = glm::determinant(map) > 0 ? -1.0f : 1.0f;
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<std::size_t>(side);
      behind_wrist_m_[s] = behind_wrist_m(twin.true_hand(side));
      forearms_[s] = make_forearm(twin.true_hand(side), kBareArm_m);
    }
  }

  FrameScore score(const msg::Projection& projection) override {
    const Light light(projection);
    see_hands(projection.lit_ns);
    const Rect area = judged_area(light);
    draw_truth(area);
    for (int y = area.y0; y < area.y1; ++y) light.row(y, area.x0, area.x1, lit_.row(y));

    FrameScore score;
    score.lit_ns = projection.lit_ns;
    score.hands.resize(seen_count_);
    for (std::size_t h = 0; h < seen_count_; ++h) score.hands[h].side = seen_[h].side;
    count_pixels(area, score);
    score_interior(area, projection, score);
    std::erase_if(score.hands, [](const FrameScore::Hand& hand) { return hand.hand_px == 0; });
    return score;
  }

 private:
  glm::vec2 to_projector(const glm::vec3& p) const {
    const glm::vec3 q = projector_from_space_ * p;
    return {q.x / q.z, q.y / q.z};
  }

  std::optional<JointFrames> joints_in_camera(Side side, std::int64_t time_ns) const {
    auto joints = twin_.joints(side, time_ns);
    if (joints)
      for (auto& frame : *joints) frame = camera_from_tracker_ * frame;
    return joints;
  }

  void see_hands(std::int64_t time_ns) {
    seen_count_ = 0;
    for (const Side side : {Side::left, Side::right}) {
      const auto joints = joints_in_camera(side, time_ns);
      if (joints) see_hand(seen_[seen_count_++], side, time_ns, *joints);
    }
  }

  void project(std::span<const glm::vec3> positions, ScreenVertices& screen) const {
    screen.resize(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const glm::vec2 px = to_projector(positions[v]);
      screen.x[v] = px.x;
      screen.y[v] = px.y;
      screen.inverse_depth[v] = 1 / positions[v].z;
    }
  }

  void see_hand(SeenHand& hand, Side side, std::int64_t time_ns, const JointFrames& joints) {
    hand.side = side;
    hand.mesh = &twin_.true_hand(side);
    hand.behind_wrist_m = &behind_wrist_m_[static_cast<std::size_t>(side)];
    hand.forearm = &forearms_[static_cast<std::size_t>(side)];
    const std::size_t count = hand.mesh->vertex_count();
    for (auto* buffer : {&now_, &before_, &after_}) buffer->resize(count);
    renderer::skin(*hand.mesh, joints, now_);
    // A hand that appears or disappears within the step is taken to rest in the missing half.
    renderer::skin(*hand.mesh, joints_in_camera(side, time_ns - kVelocityStep_ns).value_or(joints),
                   before_);
    renderer::skin(*hand.mesh, joints_in_camera(side, time_ns + kVelocityStep_ns).value_or(joints),
                   after_);
    project(now_, hand.screen);

    constexpr float kPerSecond = 1e9f / (2 * kVelocityStep_ns);
    hand.velocity_m_s.resize(count);
    hand.velocity_px_s.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
      hand.velocity_m_s[v] = (after_[v] - before_[v]) * kPerSecond;
      hand.velocity_px_s[v] = (to_projector(after_[v]) - to_projector(before_[v])) * kPerSecond;
    }
    for (int j = 0; j < kJoints; ++j) hand.joints_px[j] = to_projector(glm::vec3(joints[j][3]));

    now_.clear();
    for (const glm::vec3& position : hand.forearm->positions)
      now_.push_back(glm::vec3(joints[kWrist] * glm::vec4(position, 1)));
    project(now_, hand.arm);
  }

  Rect judged_area(const Light& light) const {
    Rect area = light.region();
    for (std::size_t h = 0; h < seen_count_; ++h) area = area.joined(seen_[h].screen.bounds());
    return area.within(surface_.width(), surface_.height());
  }

  /// Draws the true hands and arms into surface_ with a depth test.
  void draw_truth(const Rect& area) {
    for (int y = area.y0; y < area.y1; ++y) {
      std::fill_n(surface_.row(y) + area.x0, area.width(), kNothing);
      std::fill_n(inverse_depth_.row(y) + area.x0, area.width(), 0.0f);
    }
    const auto out = surface_.view();
    for (std::size_t h = 0; h < seen_count_; ++h) {
      const SeenHand& hand = seen_[h];
      for (std::size_t t = 0; t < hand.mesh->triangles.size(); ++t) draw_hand_triangle(h, t, area);
      for (const auto& triangle : hand.forearm->triangles)
        draw_triangle(hand.arm, triangle, front_, area, inverse_depth_.view(),
                      [&](int x, int y, float, float, float) { out.at(x, y) = kArm; });
    }
  }

  void draw_hand_triangle(std::size_t h, std::size_t t, const Rect& area) {
    const SeenHand& hand = seen_[h];
    const auto& triangle = hand.mesh->triangles[t];
    const auto& behind = *hand.behind_wrist_m;
    const float za = behind[triangle[0]], zb = behind[triangle[1]], zc = behind[triangle[2]];
    const auto out = surface_.view();
    draw_triangle(hand.screen, triangle, front_, area, inverse_depth_.view(),
                  [&](int x, int y, float a, float b, float c) {
                    out.at(x, y) =
                        a * za + b * zb + c * zc > kArmBegins_m ? kArm : surface_of(h, t);
                  });
  }

  void count_pixels(const Rect& area, FrameScore& score) const {
    for (std::size_t h = 0; h < seen_count_; ++h)
      count_hand(h, seen_[h].screen.bounds().within(surface_.width(), surface_.height()),
                 score.hands[h]);
    if (seen_count_ > 0) count_spill(area, score);
    for (auto& hand : score.hands) hand.union_px = hand.hand_px + hand.spill_px;
  }

  void count_hand(std::size_t h, const Rect& bounds, FrameScore::Hand& score) const {
    for (int y = bounds.y0; y < bounds.y1; ++y) {
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        const Surface surface = surface_.at(x, y);
        if (surface < kFirstTriangle || hand_of(surface) != h) continue;
        const bool lit = lit_.at(x, y) != 0;
        ++score.hand_px;
        score.lit_px += lit;
        if (x + 1 < bounds.x1) score.seam_px += edge_of_light(surface, lit, x + 1, y);
        if (y + 1 < bounds.y1) score.seam_px += edge_of_light(surface, lit, x, y + 1);
      }
    }
  }

  /// Counts the light beside hands and arms by blocks, for the hand nearest to the block's centre.
  void count_spill(const Rect& area, FrameScore& score) const {
    constexpr int kBlock = 16;
    for (int top = area.y0; top < area.y1; top += kBlock)
      for (int left = area.x0; left < area.x1; left += kBlock) {
        const int right = std::min(left + kBlock, area.x1),
                  bottom = std::min(top + kBlock, area.y1);
        int spill_px = 0;
        for (int y = top; y < bottom; ++y)
          spill_px += spill_in(surface_.row(y) + left, lit_.row(y) + left, right - left);
        if (spill_px > 0)
          score.hands[nearest_hand((left + right) / 2, (top + bottom) / 2)].spill_px += spill_px;
      }
  }

  /// 1 if the neighbour is of the same hand and just one of the two is lit, else 0.
  int edge_of_light(Surface surface, bool lit, int x, int y) const {
    const Surface neighbour = surface_.at(x, y);
    return neighbour >= kFirstTriangle && hand_of(neighbour) == hand_of(surface) &&
           (lit_.at(x, y) != 0) != lit;
  }

  std::size_t nearest_hand(int x, int y) const {
    if (seen_count_ == 1) return 0;
    const auto distance2 = [&](const SeenHand& hand) {
      float nearest = std::numeric_limits<float>::max();
      for (const glm::vec2& joint : hand.joints_px) {
        const glm::vec2 d = joint - glm::vec2(x, y);
        nearest = std::min(nearest, glm::dot(d, d));
      }
      return nearest;
    };
    return distance2(seen_[1]) < distance2(seen_[0]) ? 1 : 0;
  }

  void score_interior(const Rect& area, const msg::Projection& projection,
                      FrameScore& score) const {
    std::array<const msg::ProjectedHand*, 2> drawn{};
    for (std::size_t h = 0; h < seen_count_; ++h) drawn[h] = drawn_hand(projection, seen_[h]);
    std::array<std::int64_t, 2> points{};
    for (int y = (area.y0 + step_px_ - 1) / step_px_ * step_px_; y < area.y1; y += step_px_)
      for (int x = (area.x0 + step_px_ - 1) / step_px_ * step_px_; x < area.x1; x += step_px_) {
        const Surface surface = surface_.at(x, y);
        if (surface < kFirstTriangle) continue;
        const std::size_t h = hand_of(surface);
        score_point(seen_[h], triangle_of(surface), glm::vec2(x, y), drawn[h], score.hands[h]);
        ++points[h];
      }
    for (std::size_t h = 0; h < seen_count_; ++h)
      if (points[h] > 0) score.hands[h].speed_m_s /= static_cast<double>(points[h]);
  }

  static const msg::ProjectedHand* drawn_hand(const msg::Projection& projection,
                                              const SeenHand& hand) {
    for (std::uint32_t i = 0; i < projection.hand_count && i < projection.hands.size(); ++i) {
      const auto& drawn = projection.hands[i];
      if (drawn.side == hand.side && drawn.vertex_count == hand.mesh->vertex_count()) return &drawn;
    }
    return nullptr;
  }

  /// Scores one visible point of the true surface: the distance between it and the place where the
  /// light drawn for it lands.
  void score_point(const SeenHand& hand, std::size_t t, glm::vec2 place,
                   const msg::ProjectedHand* drawn, FrameScore::Hand& score) const {
    const auto& triangle = hand.mesh->triangles[t];
    const glm::vec3 share = barycentrics(hand.screen, triangle, place.x, place.y);
    glm::vec2 landing(0), velocity_px_s(0);
    glm::vec3 velocity_m_s(0);
    float inverse_depth = 0;
    for (int c = 0; c < 3; ++c) {
      const std::uint16_t v = triangle[c];
      if (drawn) landing += share[c] * glm::vec2(drawn->landings[v].x_px, drawn->landings[v].y_px);
      velocity_px_s += share[c] * hand.velocity_px_s[v];
      velocity_m_s += share[c] * hand.velocity_m_s[v];
      inverse_depth += share[c] * hand.screen.inverse_depth[v];
    }
    score.speed_m_s += glm::length(velocity_m_s);  // divided by the number of points at the end
    const glm::vec2 error = landing - place;
    if (!drawn || !std::isfinite(error.x) || !std::isfinite(error.y)) return;
    const float error_px = glm::length(error);
    score.interior_px.push_back(error_px);
    score.interior_mm.push_back(error_px * mm_per_px_at_1_m_ / inverse_depth);
    // Late light lands behind the point: error = -latency * velocity.
    score.lag_px_s -= glm::dot(error, velocity_px_s);
    score.speed2_px_s2 += glm::dot(velocity_px_s, velocity_px_s);
  }

  const Twin& twin_;
  int step_px_;
  glm::mat4 camera_from_tracker_;
  glm::mat3 projector_from_space_;  ///< camera space (metres) to homogeneous projector px
  float mm_per_px_at_1_m_;
  float front_ = -1;  ///< sign of the area of triangles that face the projector
  std::array<std::vector<float>, 2> behind_wrist_m_;
  std::array<Forearm, 2> forearms_;

  std::array<SeenHand, 2> seen_;
  std::size_t seen_count_ = 0;
  std::vector<glm::vec3> now_, before_, after_;
  renderer::Image<Surface> surface_;
  renderer::Image<float> inverse_depth_;
  renderer::Image<std::uint8_t> lit_;
};

}  // namespace

std::unique_ptr<Judge> Judge::create(const Twin& twin, const calib::Calibration& calibration,
                                     int step_px) {
  return std::make_unique<RigJudge>(twin, calibration, step_px);
}

}  // namespace handcast::twin
