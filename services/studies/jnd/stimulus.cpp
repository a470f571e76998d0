// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/stimulus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/base/mip_chain.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/skin/bone_fit.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/lab/gallery/lit_skin.hpp"
#include "services/lab/perception/viewer.hpp"
#include "services/lab/twin/skin_pattern.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::study {
namespace {

using renderer::Rect;

constexpr auto kSide = renderer::Side::left;
constexpr double kDistance_m = 0.73;  ///< from the viewer to the twin's hand; its perspective
constexpr double kSkinTexture = 0.1;  ///< config::TwinImage::texture of a hand in daylight
constexpr int kFillReach_px = 32;
constexpr double kStep_s = 1.0 / 30;

}  // namespace

struct Stimulus::Parts {
  /// The hand on the screen at one moment.
  struct Placed {
    std::vector<glm::vec2> position_px;
    std::vector<float> depth_m, shade;
    Rect bounds;
  };

  StimulusSettings settings;
  calib::Calibration calibration;
  std::unique_ptr<twin::Twin> twin;
  renderer::HandMesh mesh;
  renderer::BoneFit bone_fit;
  std::vector<float> skin;  ///< factor by vertex
  renderer::MipChain content;
  std::unique_ptr<renderer::Painter> painter;
  Placed hand, light;
  renderer::Texture shade, picture;
  renderer::Image<std::uint8_t> mask;
  Rect region;
  std::vector<glm::vec3> positions_m, normals;

  void place(double time_s, Placed& placed);
  renderer::DrawnHand drawn(const Placed& placed) const {
    return {.mesh = &mesh, .position_px = placed.position_px, .depth_m = placed.depth_m};
  }
  void draw_hand();
  void draw_light(Condition condition);
  void compose();
};

void Stimulus::Parts::place(double time_s, Placed& placed) {
  placed.bounds = {};
  const auto joints = twin->joints(kSide, seconds_to_ns(time_s));
  placed.position_px.clear();
  if (!joints) return;
  auto frames = bone_fit(*joints);
  for (auto& frame : frames) frame = glm::mat4(calibration.camera_from_tracker) * frame;
  positions_m.resize(mesh.vertex_count());
  normals.resize(mesh.vertex_count());
  renderer::skin(mesh, frames, positions_m, normals);
  const double focal_px = 1e3 * settings.px_per_mm * kDistance_m;
  const glm::dvec2 middle_px(0.5 * (settings.width_px - 1), 0.5 * (settings.height_px - 1));
  glm::vec2 low(1e9f), high(-1e9f);
  placed.depth_m.clear();
  placed.shade.clear();
  for (std::size_t v = 0; v < positions_m.size(); ++v) {
    const glm::dvec3 at = positions_m[v];
    placed.position_px.emplace_back(focal_px * glm::dvec2(at) / at.z + middle_px);
    placed.depth_m.push_back(positions_m[v].z);
    const float lambert =
        std::clamp(-glm::dot(normals[v], glm::normalize(positions_m[v])), 0.05f, 1.f);
    placed.shade.push_back(std::clamp(lambert * skin[v], 0.f, 1.f));
    low = glm::min(low, placed.position_px.back());
    high = glm::max(high, placed.position_px.back());
  }
  const glm::ivec2 first = glm::ivec2(glm::floor(low)) - 1, last = glm::ivec2(high) + 2;
  placed.bounds =
      Rect{first.x, first.y, last.x, last.y}.within(settings.width_px, settings.height_px);
}

/// Draws the hand without light, and where it is.
void Stimulus::Parts::draw_hand() {
  auto hand_in_grey = drawn(hand);
  hand_in_grey.light = hand.shade;
  painter->draw({&hand_in_grey, 1}, region);
  const auto colour = painter->colour();
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) {
      shade.at(x, y) = colour.at(x, y);
      mask.at(x, y) = colour.at(x, y) >> 24 ? 255 : 0;
    }
}

void Stimulus::Parts::draw_light(Condition condition) {
  auto lit = drawn(light);
  lit.picture = content.view();
  painter->draw({&lit, light.position_px.empty() ? 0u : 1u}, region);
  if (condition == Condition::baseline) return;
  config::Fill fill;
  fill.reach_px = kFillReach_px;
  painter->fill(mask.view(), fill, region);
}

void Stimulus::Parts::compose() {
  std::ranges::fill(picture.pixels(), gallery::kNight);
  const auto colour = painter->colour();
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x)
      if (mask.at(x, y))
        picture.at(x, y) = gallery::lit_skin(shade.at(x, y) & 0xff, colour.at(x, y));
}

Result<Stimulus> Stimulus::open(const StimulusSettings& settings) {
  auto rig = config::parse_rig(
      "", "study",
      {"twin.motion=" + settings.motion, fmt::format("twin.speed={}", settings.speed)});
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::reference_rig();
  auto twin = twin::Twin::create(*rig, calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  if (!(*twin)->joints(kSide, 0))
    return fail(Errc::bad_config, fmt::format("{}: there is no left hand", settings.motion));
  auto mesh = renderer::load_hand_or_default(rig->hand.left, kSide);
  if (!mesh) return tl::make_unexpected(mesh.error());
  auto content = renderer::load_content(settings.content, *mesh);
  if (!content) return tl::make_unexpected(content.error());
  renderer::BoneFit bone_fit(*mesh);
  for (int k = 0; k < 60; ++k)
    if (const auto joints = (*twin)->joints(kSide, k * seconds_to_ns(kStep_s)))
      bone_fit.learn(k * seconds_to_ns(kStep_s), *joints);
  config::TwinImage image;
  image.texture = kSkinTexture;
  auto skin = twin::skin_pattern(*mesh, image, twin::Random(1, twin::Stream::image_texture));
  const int width = settings.width_px, height = settings.height_px;
  auto parts =
      std::unique_ptr<Parts>(new Parts{.settings = settings,
                                       .calibration = calibration,
                                       .twin = std::move(*twin),
                                       .mesh = std::move(*mesh),
                                       .bone_fit = bone_fit,
                                       .skin = std::move(skin),
                                       .content = renderer::MipChain(*content, true),
                                       .painter = renderer::make_cpu_painter(width, height),
                                       .hand = {},
                                       .light = {},
                                       .shade = renderer::Texture(width, height),
                                       .picture = renderer::Texture(width, height),
                                       .mask = renderer::Image<std::uint8_t>(width, height),
                                       .region = {},
                                       .positions_m = {},
                                       .normals = {}});
  return Stimulus(std::move(parts));
}

Stimulus::Stimulus(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Stimulus::Stimulus(Stimulus&&) noexcept = default;
Stimulus::~Stimulus() = default;

renderer::View<const std::uint32_t> Stimulus::draw(double time_s, double delay_ms,
                                                   Condition condition) {
  Parts& all = *parts_;
  all.place(time_s, all.hand);
  all.place(time_s - 1e-3 * delay_ms, all.light);
  all.region = all.hand.bounds.joined(all.light.bounds);
  if (all.hand.position_px.empty() || all.region.empty()) {
    std::ranges::fill(all.picture.pixels(), gallery::kNight);
    return all.picture.view();
  }
  all.draw_hand();
  all.draw_light(condition);
  all.compose();
  return all.picture.view();
}

Rect Stimulus::region() const { return parts_->region; }

std::vector<double> Stimulus::speeds_deg_s(double from_s, double to_s) const {
  std::vector<double> speeds;
  const auto joints_at = [&](double time_s) {
    return parts_->twin->joints(kSide, seconds_to_ns(time_s));
  };
  for (double time_s = from_s; time_s + kStep_s <= to_s; time_s += kStep_s) {
    const auto here = joints_at(time_s), there = joints_at(time_s + kStep_s);
    if (!here || !there) continue;
    for (std::size_t joint = 0; joint < here->size(); ++joint) {
      const glm::vec3 moved_m = glm::vec3((*there)[joint][3]) - glm::vec3((*here)[joint][3]);
      speeds.push_back(perception::degrees_per_s(glm::length(moved_m) / kStep_s));
    }
  }
  return speeds;
}

}  // namespace handcast::study
