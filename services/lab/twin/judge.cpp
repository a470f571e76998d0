// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/judged_light.hpp"
#include "services/lab/twin/texture_lookup.hpp"
#include "services/lab/twin/true_view.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::twin {
namespace {

using renderer::Rect;

class RigJudge final : public Judge {
 public:
  RigJudge(const Twin& twin, const calib::Calibration& seen, int step_px)
      : step_px_((std::max(step_px, 1) + kStep - 1) / kStep * kStep),
        view_(twin, seen),
        texture_(twin),
        alpha_(seen.projector.width_px, seen.projector.height_px) {
    for (const Side side : {Side::left, Side::right})
      fingers_[static_cast<std::size_t>(side)] = fingers_of(twin.true_hand(side).mesh);
  }

  FrameScore score(const msg::Projection& projection, std::int64_t epoch_ns) override {
    const JudgedLight light(projection);
    const std::int64_t display_ns = projection.lit_ns - epoch_ns;
    view_.pose(display_ns);
    const Rect area = judged_area(light);
    view_.draw(area);
    for (int y = area.y0; y < area.y1; ++y) light.row(y, area.x0, area.x1, alpha_.row(y));
    for (const auto& hand : view_.hands()) texture_.place(hand);

    FrameScore score;
    score.display_ns = display_ns;
    score.hands.resize(view_.hands().size());
    for (std::size_t h = 0; h < score.hands.size(); ++h) score.hands[h].side = seen(h).side;
    count_pixels(area, light, score);
    score_interior(area, light, score);
    leave_out_hidden(score);
    return score;
  }

 private:
  static constexpr int kStep = msg::Projection::kShownStep_px;
  const SeenHand& seen(std::size_t h) const { return view_.hands()[h]; }

  Rect judged_area(const JudgedLight& light) const {
    Rect area = light.region();
    for (const auto& hand : view_.hands()) area = area.joined(hand.screen.bounds());
    return area.within(alpha_.width(), alpha_.height());
  }

  /// A hand outside the image is not scored; the light meant for it is.
  static void leave_out_hidden(FrameScore& score) {
    const auto is_hidden = [](const FrameScore::Hand& hand) { return hand.hand_px == 0; };
    for (const auto& hand : score.hands)
      if (is_hidden(hand)) score.stray_px += hand.spill_px;
    std::erase_if(score.hands, is_hidden);
  }

  void count_pixels(const Rect& area, const JudgedLight& light, FrameScore& score) const {
    for (std::size_t h = 0; h < score.hands.size(); ++h)
      count_hand(h, light.least_alpha(seen(h).side), score.hands[h]);
    count_spill(area, score);
    for (auto& hand : score.hands) hand.union_px = hand.hand_px + hand.spill_px;
  }

  void count_hand(std::size_t h, int least_alpha, FrameScore::Hand& score) const {
    const Rect bounds = seen(h).screen.bounds().within(alpha_.width(), alpha_.height());
    const auto surface = view_.surface();
    const auto is_of_hand = [&](int x, int y) {
      return is_hand(surface.at(x, y)) && hand_of(surface.at(x, y)) == h;
    };
    const auto is_lit = [&](int x, int y) { return alpha_.at(x, y) >= least_alpha; };
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        if (!is_of_hand(x, y)) continue;
        const bool lit = is_lit(x, y);
        ++score.hand_px;
        score.lit_px += lit;
        for (const glm::ivec2 next : {glm::ivec2(x + 1, y), glm::ivec2(x, y + 1)}) {
          const bool both = next.x < bounds.x1 && next.y < bounds.y1 && is_of_hand(next.x, next.y);
          score.seam_px += both && is_lit(next.x, next.y) != lit;
          score.outline_px += both ? 0 : 2;  // the left and the upper edges are as long
        }
      }
  }

  /// Counts the light beside hands and arms by blocks, for the hand nearest to the block's centre,
  /// if there is a hand.
  void count_spill(const Rect& area, FrameScore& score) const {
    constexpr int kBlock = 16;
    for (int top = area.y0; top < area.y1; top += kBlock)
      for (int left = area.x0; left < area.x1; left += kBlock) {
        const Rect block{left, top, std::min(left + kBlock, area.x1),
                         std::min(top + kBlock, area.y1)};
        const int spill_px = spill_in(block);
        if (spill_px == 0) continue;
        if (score.hands.empty()) {
          score.stray_px += spill_px;
        } else {
          score.hands[nearest_hand((block.x0 + block.x1) / 2, (block.y0 + block.y1) / 2)]
              .spill_px += spill_px;
        }
      }
  }

  int spill_in(const Rect& block) const {
    int spill_px = 0;
    for (int y = block.y0; y < block.y1; ++y)
      for (int x = block.x0; x < block.x1; ++x)
        spill_px += view_.surface().at(x, y) == kNothing && alpha_.at(x, y) >= 128;
    return spill_px;
  }

  std::size_t nearest_hand(int x, int y) const {
    const auto distance2 = [&](const SeenHand& hand) {
      float nearest = std::numeric_limits<float>::max();
      for (const glm::vec2& joint : hand.joints_px) {
        const glm::vec2 d = joint - glm::vec2(x, y);
        nearest = std::min(nearest, glm::dot(d, d));
      }
      return nearest;
    };
    return view_.hands().size() > 1 && distance2(seen(1)) < distance2(seen(0)) ? 1 : 0;
  }

  void score_interior(const Rect& area, const JudgedLight& light, FrameScore& score) const {
    std::array<int, 2> points{};
    for (int y = (area.y0 + step_px_ - 1) / step_px_ * step_px_; y < area.y1; y += step_px_)
      for (int x = (area.x0 + step_px_ - 1) / step_px_ * step_px_; x < area.x1; x += step_px_) {
        const Surface surface = view_.surface().at(x, y);
        if (!is_hand(surface)) continue;
        score_point(surface, {x, y}, light, score.hands[hand_of(surface)]);
        ++points[hand_of(surface)];
      }
    for (std::size_t h = 0; h < score.hands.size(); ++h)
      if (points[h] > 0) score.hands[h].speed_m_s /= points[h];
  }

  /// What the scored pixel shows of the true surface.
  struct TruePoint {
    glm::vec3 seen_m{0}, rest_m{0}, velocity_m_s{0};
    glm::vec2 velocity_px_s{0};
    int finger = -1;
  };
  TruePoint true_point(Surface surface, glm::ivec2 pixel) const {
    const SeenHand& hand = seen(hand_of(surface));
    const auto& mesh = hand.truth->mesh;
    const auto& triangle = mesh.triangles[triangle_of(surface)];
    const glm::vec3 share = barycentrics(hand.screen, triangle, static_cast<float>(pixel.x),
                                         static_cast<float>(pixel.y));
    TruePoint point;
    for (int c = 0; c < 3; ++c) {
      const std::uint16_t v = triangle[c];
      point.seen_m += share[c] * hand.position_m[v];
      point.rest_m += share[c] * mesh.positions[v];
      point.velocity_m_s += share[c] * hand.velocity_m_s[v];
      point.velocity_px_s += share[c] * hand.velocity_px_s[v];
    }
    point.finger = fingers_[static_cast<std::size_t>(hand.side)][triangle[0]];
    return point;
  }

  void score_missing(const TruePoint& truth, glm::ivec2 pixel, FrameScore::Hand& score) const {
    const glm::vec3 away = truth.seen_m + glm::vec3(1e-3f * FrameScore::kMissing_mm, 0, 0);
    score.missing_px.push_back(glm::distance(view_.to_projector(away), glm::vec2(pixel)));
  }

  /// Scores one visible point of the true surface: the distance on the surface between it and the
  /// point whose picture falls on it. The distance is bounded from below, by the straight lines in
  /// the pose of the hand and at rest: a folded hand brings far points of its surface together.
  void score_point(Surface surface, glm::ivec2 pixel, const JudgedLight& light,
                   FrameScore::Hand& score) const {
    const SeenHand& hand = seen(hand_of(surface));
    const TruePoint truth = true_point(surface, pixel);
    score.speed_m_s += glm::length(truth.velocity_m_s);  // divided by the number at the end
    const auto shown = alpha_.at(pixel.x, pixel.y) >= light.least_alpha(hand.side)
                           ? light.shown(pixel.x, pixel.y)
                           : std::nullopt;
    if (!shown || shown->side != hand.side) return score_missing(truth, pixel, score);
    const auto meant = texture_.at(hand.side, shown->uv);
    const glm::vec2 error = glm::vec2(pixel) - view_.to_projector(meant.seen_m);
    // The ground truth of a broken mesh has points that are nowhere.
    if (!std::isfinite(error.x) || !std::isfinite(error.y))
      return score_missing(truth, pixel, score);
    score.interior_px.push_back(glm::length(error));
    score.interior_mm.push_back(1e3f * std::max(glm::distance(meant.seen_m, truth.seen_m),
                                                glm::distance(meant.rest_m, truth.rest_m)));
    auto& part = score.parts[truth.finger < 0 ? FrameScore::kParts - 1
                                              : static_cast<std::size_t>(truth.finger)];
    part.sum_px += error;
    ++part.points;
    // Late light lands behind the point: error = -latency * velocity.
    score.lag_px_s -= glm::dot(error, truth.velocity_px_s);
    score.speed2_px_s2 += glm::dot(truth.velocity_px_s, truth.velocity_px_s);
    score.error2_px2 += glm::dot(error, error);
  }

  int step_px_;
  TrueView view_;
  PlacedTexture texture_;
  std::array<std::vector<int>, 2> fingers_;  ///< by side and vertex of the ground-truth mesh
  renderer::Image<std::uint8_t> alpha_;
};

}  // namespace

std::unique_ptr<Judge> Judge::create(const Twin& twin, int step_px) {
  return std::make_unique<RigJudge>(twin, twin.geometry().calibration(), step_px);
}

}  // namespace handcast::twin
