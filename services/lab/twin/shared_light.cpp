// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/shared_light.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/srgb.hpp"

namespace handcast::twin {
namespace {

using renderer::Rect;

constexpr float kCovered = 0.5f;  ///< of the full light

/// The camera as a projector of its own image: what it sees of the hands.
calib::Calibration as_seen(calib::Calibration rig) {
  rig.projector = {.width_px = rig.camera.width_px, .height_px = rig.camera.height_px};
  return rig;
}

Rect bounds_of(const TrueView& view) {
  Rect area;
  for (const auto& hand : view.hands()) area = area.joined(hand.screen.bounds());
  return area.overlap(view.screen());
}

/// The barycentrics of a pixel in the triangle that it shows.
glm::vec3 share_at(const SeenHand& hand, Surface surface, glm::ivec2 px) {
  return barycentrics(hand.screen, hand.truth->mesh.triangles[triangle_of(surface)],
                      static_cast<float>(px.x), static_cast<float>(px.y));
}

/// Skin in this light and a little of the room's, RGBA8.
std::uint32_t skin_in(const glm::vec3& light) {
  constexpr float kRoom = 0.02f, kSkin = 0.85f;  // light of the room, reflectance
  std::uint32_t pixel = 0xff000000u;
  for (int c = 0; c < 3; ++c) {
    const float level = renderer::fast_srgb_level(std::min(1.0f, kSkin * (kRoom + light[c])));
    pixel |= static_cast<std::uint32_t>(std::lround(255 * level)) << (8 * c);
  }
  return pixel;
}

nlohmann::json percentiles(const Samples& values,
                           std::initializer_list<std::pair<const char*, double>> shares) {
  nlohmann::json json;
  for (const auto& [name, share] : shares)
    json[name] = values.empty() ? nlohmann::json() : nlohmann::json(values.percentile(share));
  return json;
}

}  // namespace

SharedJudge::SharedJudge(const Twin& twin, bool is_white)
    : is_white_(is_white),
      beams_{Beam(twin, twin.geometry().calibration()),
             Beam(twin,
                  calib::at_projector(twin.geometry().calibration(), config::Viewpoint::second))},
      eye_(twin, as_seen(twin.geometry().calibration())) {}

void SharedJudge::take(Beam& beam, const msg::Projection& projection) {
  beam.projection = &projection;
  beam.view.pose(projection.lit_ns);
  beam.view.draw(bounds_of(beam.view));
  for (const auto& hand : beam.view.hands()) beam.texture.place(hand);
}

void SharedJudge::add(const msg::Projection& first, const msg::Projection& second) {
  take(beams_[0], first);
  take(beams_[1], second);
  const std::array lights{JudgedLight(first), JudgedLight(second)};
  const auto count = std::min(beams_[0].view.hands().size(), beams_[1].view.hands().size());
  for (std::size_t hand = 0; hand < count; ++hand) add_hand(hand, lights);
}

/// From where a vertex is to where the light that falls on it belongs, camera space, m. Empty if no
/// light does.
std::optional<glm::vec3> SharedJudge::displacement(const Beam& beam, const JudgedLight& light,
                                                   std::size_t hand, std::size_t vertex) {
  constexpr int kStep = msg::Projection::kShownStep_px;
  const SeenHand& seen = beam.view.hands()[hand];
  const auto px = beam.view.lit_by(seen.position_m[vertex]);
  if (!px || light.light_at(px->x, px->y) == 0) return std::nullopt;
  const glm::ivec2 shown_px = (*px + kStep / 2) / kStep * kStep;
  const auto shown = light.shown(shown_px.x, shown_px.y);
  if (!shown || shown->side != seen.side || shown_px.x >= beam.view.screen().x1 ||
      shown_px.y >= beam.view.screen().y1)
    return std::nullopt;
  const Surface surface = beam.view.surface().at(shown_px.x, shown_px.y);
  if (!is_hand(surface) || hand_of(surface) != hand) return std::nullopt;
  return beam.texture.at(seen.side, shown->uv).seen_m -
         point_of(seen, surface, share_at(seen, surface, shown_px));
}

void SharedJudge::add_hand(std::size_t hand, const std::array<JudgedLight, 2>& lights) {
  const auto& mesh = beams_[0].view.hands()[hand].truth->mesh;
  of_vertex_.assign(mesh.vertex_count(), -1);
  for (std::size_t v = 0; v < of_vertex_.size(); ++v) {
    std::array<float, 2> light{-1, -1};
    for (std::size_t b = 0; b < beams_.size(); ++b) {
      const auto& view = beams_[b].view;
      if (const auto px = view.lit_by(view.hands()[hand].position_m[v]))
        light[b] = lights[b].light_at(px->x, px->y);
    }
    if (light[0] < 0 && light[1] < 0) continue;
    if (is_white_) add_light(v, light);
    if (light[0] <= 0 || light[1] <= 0) continue;
    const auto first = displacement(beams_[0], lights[0], hand, v),
               second = displacement(beams_[1], lights[1], hand, v);
    if (first && second) apart_mm_.add(1e3f * glm::distance(*first, *second));
  }
  for (const auto& [i, j, k] : mesh.triangles)
    for (const auto& [a, b] : {std::pair{i, j}, std::pair{j, k}, std::pair{k, i}})
      if (of_vertex_[a] > 0 && of_vertex_[b] > 0)
        steps_.add(std::abs(of_vertex_[a] - of_vertex_[b]));
}

/// `light`: of each projector on a vertex; negative: it is not reached.
void SharedJudge::add_light(std::size_t vertex, const std::array<float, 2>& light) {
  const float sum = std::max(light[0], 0.0f) + std::max(light[1], 0.0f);
  of_vertex_[vertex] = sum;
  ++reached_;
  covered_ += sum >= kCovered;
  covered_first_ += light[0] >= kCovered;
  if (sum > 0) light_.add(sum);
}

nlohmann::json SharedJudge::to_json() const {
  const auto share = [this](std::int64_t part) {
    return reached_ > 0 ? nlohmann::json(static_cast<double>(part) / static_cast<double>(reached_))
                        : nlohmann::json();
  };
  auto apart = percentiles(apart_mm_, {{"p95", 0.95}});
  apart["mean"] = apart_mm_.empty() ? nlohmann::json() : nlohmann::json(apart_mm_.mean());
  return {{"coverage", share(covered_)},
          {"coverage_first", share(covered_first_)},
          {"light", percentiles(light_, {{"p5", 0.05}, {"p50", 0.5}, {"p95", 0.95}})},
          {"step", percentiles(steps_, {{"p50", 0.5}, {"p99", 0.99}})},
          {"apart_mm", std::move(apart)}};
}

/// The light of a projector on a point of a hand.
glm::vec3 SharedJudge::light_on(const Beam& beam, Surface surface, const glm::vec3& share) {
  if (hand_of(surface) >= beam.view.hands().size()) return glm::vec3(0);
  const auto px = beam.view.lit_by(point_of(beam.view.hands()[hand_of(surface)], surface, share));
  return px ? JudgedLight(*beam.projection).colour_at(px->x, px->y) : glm::vec3(0);
}

renderer::View<const std::uint32_t> SharedJudge::picture() {
  const int width = eye_.screen().x1, height = eye_.screen().y1;
  picture_ = renderer::Image<std::uint32_t>(3 * width, height, 0xff1a1a1au);
  if (!beams_[0].projection) return picture_.view();
  eye_.pose(beams_[0].projection->lit_ns);
  const Rect area = bounds_of(eye_);
  eye_.draw(area);
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x) {
      const Surface surface = eye_.surface().at(x, y);
      if (!is_hand(surface)) continue;
      const auto share = share_at(eye_.hands()[hand_of(surface)], surface, {x, y});
      const auto first = light_on(beams_[0], surface, share),
                 second = light_on(beams_[1], surface, share);
      picture_.at(x, y) = skin_in(first);
      picture_.at(x + width, y) = skin_in(second);
      picture_.at(x + 2 * width, y) = skin_in(first + second);
    }
  return picture_.view();
}

}  // namespace handcast::twin
