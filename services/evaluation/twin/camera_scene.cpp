// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/camera_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "renderer/base/clones.hpp"
#include "renderer/skin/skinning.hpp"

namespace handcast::twin {
namespace {

constexpr std::size_t kNoiseSize = 1 << 18;
constexpr float kNominal_m = 0.73f;  ///< distance to which settings.gain applies
constexpr float kCornerLoss = 0.3f;  ///< vignetting at the image's corners
constexpr float kScattered = 0.4f;   ///< share of the light that is independent of the normal

HANDCAST_CLONES
void add_noise(const std::uint8_t* scene, const std::int8_t* noise, std::uint8_t* out, int count) {
  for (int x = 0; x < count; ++x) {
    const int value = scene[x] + noise[x];
    out[x] = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
  }
}

HANDCAST_CLONES
void add_row(const float* from, float* to, int count) {
  for (int x = 0; x < count; ++x) to[x] += from[x];
}

HANDCAST_CLONES
void round_row(const float* sum, float scale, std::uint8_t* out, int count) {
  for (int x = 0; x < count; ++x) {
    const float value = sum[x] * scale + 0.5f;
    out[x] = static_cast<std::uint8_t>(static_cast<int>(value > 255.0f ? 255.0f : value));
  }
}

}  // namespace

CameraScene::CameraScene(const config::TwinImage& settings, int seed,
                         const calib::Calibration& calibration)
    : settings_(settings),
      seed_(seed),
      camera_(calibration.camera),
      camera_from_tracker_(calibration.camera_from_tracker),
      image_noise_(seed, Stream::image_noise),
      empty_scene_(camera_.width_px, camera_.height_px),
      inverse_depth_(camera_.width_px, camera_.height_px),
      instant_(camera_.width_px, camera_.height_px),
      sum_(camera_.width_px, camera_.height_px) {
  for (int y = 0; y < camera_.height_px; ++y)
    for (int x = 0; x < camera_.width_px; ++x)
      empty_scene_.at(x, y) = static_cast<std::uint8_t>(
          std::lround(settings_.background * vignette(float(x), float(y))));
  make_noise(seed);
  if (settings_.face) face_ = make_face(camera_);
}

void CameraScene::make_noise(int seed) {
  const Random random(seed, Stream::image_noise);
  noise_.resize(kNoiseSize + static_cast<std::size_t>(camera_.width_px));
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    const double value = std::clamp(settings_.noise * random.normal(i, 1), -127.0, 127.0);
    noise_[i] = static_cast<std::int8_t>(std::lround(value));
  }
}

void CameraScene::set_hand(Side side, const TrueHand& flesh) {
  const renderer::HandMesh& mesh = flesh.mesh;
  auto& hand = hands_[static_cast<std::size_t>(side)];
  hand = {&flesh, make_forearm(mesh, static_cast<float>(settings_.sleeve_mm * 1e-3)), {}};
  if (settings_.holes > 0)
    hand.holes = draw_holes(mesh, settings_.holes, Random(seed_, Stream::image_holes));
}

float CameraScene::vignette(float x_px, float y_px) const {
  const glm::vec2 half(camera_.width_px / 2.0f, camera_.height_px / 2.0f);
  const glm::vec2 from_centre = glm::vec2(x_px, y_px) - half;
  return 1 -
         kCornerLoss * std::min(1.0f, glm::dot(from_centre, from_centre) / glm::dot(half, half));
}

/// Projects vertices in camera space and computes their grey values. The lamp is at the lens; its
/// light falls with 1/r^2.
void CameraScene::shoot(Shot& shot, std::span<const glm::vec3> positions,
                        std::span<const glm::vec3> normals, glm::vec2 within_pixel) {
  shot.screen.resize(positions.size());
  shot.grey.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::vec3 p = positions[v];
    const glm::vec2 px = glm::vec2(camera_.distort(camera_.project(p))) + within_pixel;
    shot.screen.x[v] = px.x;
    shot.screen.y[v] = px.y;
    shot.screen.inverse_depth[v] = 1 / p.z;
    const float distance = glm::length(p);
    const float facing = std::max(0.0f, -glm::dot(normals[v], p) / distance);
    const float fall = kNominal_m * kNominal_m / (distance * distance);
    const float light = (kScattered + (1 - kScattered) * facing) * fall * vignette(px.x, px.y);
    shot.grey[v] = static_cast<float>(settings_.gain) * light;
  }
}

CameraScene::Shot& CameraScene::next_shot(std::size_t& count) {
  if (shots_.size() == count) shots_.emplace_back();
  return shots_[count++];
}

renderer::Rect CameraScene::shoot_face(std::int64_t time_ns, glm::vec2 within_pixel,
                                       std::size_t& count) {
  if (!faulty_ || face_.positions.empty()) return {};
  positions_ = face_.positions;
  for (auto& position : positions_) position += face_sway_m(time_ns);
  Shot& face = next_shot(count);
  shoot(face, positions_, face_.normals, within_pixel);
  face.triangles = &face_.triangles;
  return face.screen.bounds().within(camera_.width_px, camera_.height_px);
}

renderer::Rect CameraScene::shoot_hands(std::int64_t time_ns, const TruthAt& truth,
                                        glm::vec2 within_pixel, std::size_t& count) {
  renderer::Rect bounds;
  for (const Side side : {Side::left, Side::right}) {
    const Hand& hand = hands_[static_cast<std::size_t>(side)];
    auto joints = hand.flesh ? truth(side, time_ns) : std::nullopt;
    if (!joints) continue;
    for (auto& frame : *joints) frame = camera_from_tracker_ * frame;

    positions_.resize(hand.flesh->mesh.vertex_count());
    normals_.resize(hand.flesh->mesh.vertex_count());
    pose(*hand.flesh, *joints, positions_, normals_);
    Shot& skin = next_shot(count);
    shoot(skin, positions_, normals_, within_pixel);
    if (faulty_ && !hand.holes.empty())
      for (std::size_t v = 0; v < skin.grey.size(); ++v) skin.grey[v] *= hand.holes[v];
    skin.triangles = &hand.flesh->mesh.triangles;
    bounds = bounds.joined(skin.screen.bounds());

    const Forearm& arm = hand.forearm;
    const glm::mat4& wrist = (*joints)[1];
    positions_.resize(arm.positions.size());
    normals_.resize(arm.positions.size());
    for (std::size_t v = 0; v < arm.positions.size(); ++v) {
      positions_[v] = glm::vec3(wrist * glm::vec4(arm.positions[v], 1));
      normals_[v] = glm::mat3(wrist) * arm.normals[v];
    }
    Shot& forearm = next_shot(count);
    shoot(forearm, positions_, normals_, within_pixel);
    for (std::size_t v = 0; v < forearm.grey.size(); ++v) forearm.grey[v] *= arm.brightness[v];
    forearm.triangles = &arm.triangles;
    bounds = bounds.joined(forearm.screen.bounds());
  }
  return bounds.within(camera_.width_px, camera_.height_px);
}

/// Adds one instant to sum_, inside `region`.
void CameraScene::expose(std::size_t shots, const renderer::Rect& region) {
  for (int y = region.y0; y < region.y1; ++y) {
    std::fill_n(inverse_depth_.row(y) + region.x0, region.width(), 0.0f);
    std::copy_n(empty_scene_.row(y) + region.x0, region.width(), instant_.row(y) + region.x0);
  }
  const auto depth = inverse_depth_.view();
  const auto out = instant_.view();
  constexpr float kFront = -1;  // counter-clockwise from outside, on a screen whose y points down
  for (std::size_t s = 0; s < shots; ++s) {
    const Shot& shot = shots_[s];
    for (const auto& triangle : *shot.triangles) {
      const float ga = shot.grey[triangle[0]], gb = shot.grey[triangle[1]],
                  gc = shot.grey[triangle[2]];
      draw_triangle(shot.screen, triangle, kFront, region, depth,
                    [&](int x, int y, float a, float b, float c) {
                      out.at(x, y) = a * ga + b * gb + c * gc;
                    });
    }
  }
  for (int y = region.y0; y < region.y1; ++y)
    add_row(instant_.row(y) + region.x0, sum_.row(y) + region.x0, region.width());
}

void CameraScene::develop(std::uint64_t k, const renderer::Rect& region, int instants,
                          renderer::View<std::uint8_t> image) const {
  const int width = std::min(image.width, camera_.width_px);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(camera_.width_px));
  for (int y = 0; y < std::min(image.height, camera_.height_px); ++y) {
    const std::int8_t* noise =
        &noise_[image_noise_.bits(k, 2 + static_cast<std::uint64_t>(y)) % kNoiseSize];
    std::memcpy(row.data(), empty_scene_.row(y), row.size());
    if (y >= region.y0 && y < region.y1)
      round_row(sum_.row(y) + region.x0, 1 / static_cast<float>(instants), row.data() + region.x0,
                region.width());
    if (faulty_) spoil_row(settings_, row);
    add_noise(row.data(), noise, image.row(y), width);
  }
}

/// Initialises the part of `region` outside `done`: it was empty scene in all `instants` so far.
void CameraScene::start_sum(const renderer::Rect& region, const renderer::Rect& done,
                            int instants) {
  const auto fill = [&](int y, int x0, int x1) {
    for (int x = x0; x < x1; ++x)
      sum_.at(x, y) = static_cast<float>(instants) * empty_scene_.at(x, y);
  };
  for (int y = region.y0; y < region.y1; ++y) {
    const bool known = !done.empty() && y >= done.y0 && y < done.y1;
    fill(y, region.x0, known ? done.x0 : region.x1);
    if (known) fill(y, done.x1, region.x1);
  }
}

void CameraScene::draw(std::uint64_t k, std::int64_t origin_ns, std::int64_t exposure_ns,
                       const TruthAt& truth, renderer::View<std::uint8_t> image) {
  faulty_ = settings_.fault.holds(ns_to_seconds(origin_ns));
  const int instants = settings_.blur_samples;
  renderer::Rect region, done;
  for (int i = 0; i < instants; ++i) {
    // The instants also differ in their position within the pixel, which antialiases the edges.
    const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(instants) - 0.5f;
    std::size_t shots = 0;
    const auto time_ns =
        origin_ns + static_cast<std::int64_t>(at * static_cast<double>(exposure_ns));
    region = shoot_hands(time_ns, truth, {at, -at}, shots).joined(region);
    region = shoot_face(time_ns, {at, -at}, shots).joined(region);
    start_sum(region, done, i);
    done = region;
    expose(shots, region);
  }
  develop(k, region, instants, image);
}

}  // namespace handcast::twin
