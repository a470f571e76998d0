// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/camera_scene.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/base/clones.hpp"
#include "services/lab/twin/background.hpp"
#include "services/lab/twin/grey_surface.hpp"
#include "services/lab/twin/person.hpp"
#include "services/lab/twin/skin_pattern.hpp"
#include "services/lab/twin/solid.hpp"

namespace handcast::twin {
namespace {

/// Signs of the area of visible triangles on a screen whose y points down.
constexpr float kFront = -1, kFrontInMirror = 1;

HANDCAST_CLONES
void add_row(const float* from, float* to, int count) {
  for (int x = 0; x < count; ++x) to[x] += from[x];
}

}  // namespace

CameraScene::CameraScene(const config::TwinImage& settings, int seed,
                         const calib::PlacedCamera& camera)
    : settings_(settings),
      seed_(seed),
      camera_(camera.model),
      camera_from_tracker_(camera.from_tracker),
      background_(make_background(settings, camera_, Random(seed, Stream::image_clutter))),
      sensor_(settings, seed, camera_.width_px),
      table_spread_(settings.table > 0 ? kTableBlur_px : 0),
      inverse_depth_(camera_.width_px + kSpare_px, camera_.height_px),
      instant_(camera_.width_px + kSpare_px, camera_.height_px),
      sum_(camera_.width_px, camera_.height_px) {
  if (settings_.face) face_ = make_face(camera_);
  if (settings_.object) object_ = make_held_object();
  if (settings_.reflector_mm > 0) reflector_ = make_reflector(settings_.reflector_mm * 1e-3);
  if (settings_.table > 0)
    mirror_image_ = renderer::Image<float>(camera_.width_px, camera_.height_px);
}

void CameraScene::set_hand(Side side, const TrueHand& truth) {
  const renderer::HandMesh& mesh = truth.mesh;
  auto& hand = hands_[static_cast<std::size_t>(side)];
  hand = {&truth,
          make_forearm(mesh, static_cast<float>(settings_.sleeve_mm * 1e-3)),
          {},
          skin_pattern(mesh, settings_, Random(seed_, Stream::image_texture))};
  if (settings_.texture > 0) {
    const Random noise(seed_, Stream::image_texture);
    const auto pattern = noise_pattern(hand.forearm.positions, settings_.texture, noise);
    for (std::size_t v = 0; v < pattern.size(); ++v) hand.forearm.brightness[v] *= pattern[v];
  }
  if (settings_.holes > 0)
    hand.holes = draw_holes(mesh, settings_.holes, Random(seed_, Stream::image_holes));
}

/// Projects positions_ and computes their grey values.
void CameraScene::shoot(Shot& shot, glm::vec2 within_pixel) {
  if (in_mirror_) mirror_in_table(positions_, normals_);
  shot.screen.resize(positions_.size());
  shot.grey.resize(positions_.size());
  const float wrap = wrap_of(settings_.subsurface_mm);
  const auto sun = static_cast<float>(settings_.sunlight);
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    const glm::vec3 p = positions_[v];
    const glm::vec2 px = glm::vec2(camera_.distort(camera_.project(p))) + within_pixel;
    shot.screen.x[v] = px.x;
    shot.screen.y[v] = px.y;
    shot.screen.inverse_depth[v] = 1 / p.z;
    float light = lamp_on(p, normals_[v], wrap);
    if (sun > 0) light += sun * facing(glm::dot(normals_[v], to_sun()), wrap);
    light *= vignette_at(camera_, px.x, px.y);
    shot.grey[v] = static_cast<float>(settings_.gain) * light;
  }
}

CameraScene::Shot& CameraScene::next_shot(std::size_t& count) {
  if (shots_.size() == count) shots_.emplace_back();
  return shots_[count++];
}

void CameraScene::shoot_solid(const Solid& solid, const glm::mat4& camera_from_solid,
                              float brightness, glm::vec2 within_pixel, std::size_t& count) {
  positions_.resize(solid.positions.size());
  normals_.resize(solid.positions.size());
  for (std::size_t v = 0; v < solid.positions.size(); ++v) {
    positions_[v] = glm::vec3(camera_from_solid * glm::vec4(solid.positions[v], 1));
    normals_[v] = glm::mat3(camera_from_solid) * solid.normals[v];
  }
  Shot& shot = next_shot(count);
  shoot(shot, within_pixel);
  for (float& grey : shot.grey) grey *= brightness;
  shot.triangles = &solid.triangles;
}

/// `tip_m`: camera space.
void CameraScene::shoot_reflector(const glm::vec3& tip_m, glm::vec2 within_pixel,
                                  std::size_t& count) {
  glm::mat4 place(1);
  const float nearer = 1 - kReflectorNearer_m / tip_m.z;
  for (int axis = 0; axis < 3; ++axis) place[axis][axis] = nearer;  // the same size in the image
  place[3] = glm::vec4(nearer * tip_m, 1);
  shoot_solid(reflector_, place, 1, within_pixel, count);
  std::ranges::fill(shots_[count - 1].grey, kReflectorGrey);
}

renderer::Rect CameraScene::shoot_face(std::int64_t time_ns, glm::vec2 within_pixel,
                                       std::size_t& count) {
  if (!faulty_ || face_.positions.empty()) return {};
  glm::mat4 sway(1);
  sway[3] = glm::vec4(face_sway_m(time_ns), 1);
  shoot_solid(face_, sway, 1, within_pixel, count);
  return shots_[count - 1].screen.bounds().within(camera_.width_px, camera_.height_px);
}

/// Appends a hand and its forearm. `joints`: camera space.
void CameraScene::shoot_hand(const Hand& hand, const JointFrames& joints, glm::vec2 within_pixel,
                             std::size_t& count) {
  positions_.resize(hand.truth->mesh.vertex_count());
  normals_.resize(hand.truth->mesh.vertex_count());
  pose(*hand.truth, joints, positions_, normals_);
  Shot& skin = next_shot(count);
  shoot(skin, within_pixel);
  for (std::size_t v = 0; v < hand.pattern.size(); ++v) skin.grey[v] *= hand.pattern[v];
  if (faulty_ && !hand.holes.empty())
    for (std::size_t v = 0; v < skin.grey.size(); ++v) skin.grey[v] *= hand.holes[v];
  skin.triangles = &hand.truth->mesh.triangles;

  const Forearm& arm = hand.forearm;
  positions_.resize(arm.positions.size());
  normals_.resize(arm.positions.size());
  for (std::size_t v = 0; v < arm.positions.size(); ++v) {
    positions_[v] = glm::vec3(joints[1] * glm::vec4(arm.positions[v], 1));
    normals_[v] = glm::mat3(joints[1]) * arm.normals[v];
  }
  Shot& forearm = next_shot(count);
  shoot(forearm, within_pixel);
  for (std::size_t v = 0; v < forearm.grey.size(); ++v) forearm.grey[v] *= arm.brightness[v];
  forearm.triangles = &arm.triangles;
}

renderer::Rect CameraScene::shoot_hands(std::int64_t time_ns, const TruthAt& truth,
                                        glm::vec2 within_pixel, std::size_t& count) {
  const std::size_t first = count;
  for (const Side side : {Side::left, Side::right}) {
    const Hand& hand = hands_[static_cast<std::size_t>(side)];
    auto joints = hand.truth ? truth(side, time_ns) : std::nullopt;
    if (!joints) continue;
    for (auto& frame : *joints) frame = camera_from_tracker_ * frame;
    shoot_hand(hand, *joints, within_pixel, count);
    if (faulty_ && !object_.positions.empty())
      shoot_solid(object_, (*joints)[0], kObjectBrightness, within_pixel, count);
    constexpr int kIndexTip = 10;
    if (!reflector_.positions.empty())
      shoot_reflector(glm::vec3((*joints)[kIndexTip][3]), within_pixel, count);
  }
  renderer::Rect bounds;
  for (std::size_t s = first; s < count; ++s) bounds = bounds.joined(shots_[s].screen.bounds());
  return bounds.within(camera_.width_px, camera_.height_px);
}

/// Draws shots [first, last) into instant_, inside `region`.
void CameraScene::draw_shots(std::size_t first, std::size_t last, float front,
                             const renderer::Rect& region) {
  for (int y = region.y0; y < region.y1; ++y)
    std::fill_n(inverse_depth_.row(y) + region.x0, region.width(), 0.0f);
  for (std::size_t s = first; s < last; ++s)
    draw_grey(shots_[s].screen, shots_[s].grey, *shots_[s].triangles, front, region,
              inverse_depth_.view(), instant_.view());
}

/// Draws the hands as the glossy table shows them into mirror_image_; returns their bounds.
renderer::Rect CameraScene::draw_mirror_image(std::int64_t time_ns, const TruthAt& truth) {
  for (int y = mirrored_.y0; y < mirrored_.y1; ++y)
    std::fill_n(mirror_image_.row(y) + mirrored_.x0, mirrored_.width(), 0.0f);
  mirrored_ = {};
  if (settings_.table == 0) return {};
  std::size_t count = 0;
  in_mirror_ = true;
  mirrored_ = shoot_hands(time_ns, truth, {}, count).grown(table_spread_.reach_px());
  in_mirror_ = false;
  mirrored_ = mirrored_.within(camera_.width_px, camera_.height_px);
  for (int y = mirrored_.y0; y < mirrored_.y1; ++y)
    std::fill_n(instant_.row(y) + mirrored_.x0, mirrored_.width(), 0.0f);
  draw_shots(0, count, kFrontInMirror, mirrored_);
  for (int y = mirrored_.y0; y < mirrored_.y1; ++y)
    for (int x = mirrored_.x0; x < mirrored_.x1; ++x)
      mirror_image_.at(x, y) = static_cast<float>(settings_.table) * instant_.at(x, y);
  table_spread_.spread(mirror_image_.view(), mirrored_);
  return mirrored_;
}

/// Copies the background and the mirror image to instant_, inside `region`.
void CameraScene::copy_background(const renderer::Rect& region) {
  for (int y = region.y0; y < region.y1; ++y)
    std::copy_n(background_.row(y) + region.x0, region.width(), instant_.row(y) + region.x0);
  const renderer::Rect both = mirrored_.overlap(region);
  if (both.empty()) return;
  for (int y = both.y0; y < both.y1; ++y)
    add_row(mirror_image_.row(y) + both.x0, instant_.row(y) + both.x0, both.width());
}

/// Adds one instant to sum_, inside `region`.
void CameraScene::expose(std::size_t shots, const renderer::Rect& region) {
  copy_background(region);
  draw_shots(0, shots, kFront, region);
  for (int y = region.y0; y < region.y1; ++y)
    add_row(instant_.row(y) + region.x0, sum_.row(y) + region.x0, region.width());
}

/// Draws the second person into the background. Four positions within a pixel antialias the edges.
void CameraScene::add_bystander() {
  const Hand& hand = hands_[0].truth ? hands_[0] : hands_[1];
  if (!hand.truth || hand.truth->mesh.positions.empty()) return;
  const renderer::Rect all{0, 0, camera_.width_px, camera_.height_px};
  const auto joints = bystander_joints(hand.truth->mesh, camera_);
  renderer::Image<float> mean(camera_.width_px, camera_.height_px);
  constexpr int kPositions = 4;
  for (int i = 0; i < kPositions; ++i) {
    std::size_t count = 0;
    const glm::vec2 within_pixel(static_cast<float>(i) / kPositions - 0.375f,
                                 static_cast<float>(i ^ 1) / kPositions - 0.375f);
    shoot_hand(hand, joints, within_pixel, count);
    copy_background(all);
    draw_shots(0, count, kFront, all);
    for (int y = 0; y < all.y1; ++y)
      for (int x = 0; x < all.x1; ++x) mean.at(x, y) += instant_.at(x, y) / kPositions;
  }
  background_ = std::move(mean);
}

/// Completes what does not move; done once, before the first frame.
void CameraScene::finish_background() {
  if (settings_.second_person) add_bystander();
  for (float& grey : background_.pixels()) grey = std::round(std::clamp(grey, 0.0f, 255.0f));
  sensor_.set_empty_scene(background_);
}

/// Initialises the part of `region` outside `done`: it was empty scene in all `instants` so far.
void CameraScene::start_sum(const renderer::Rect& region, const renderer::Rect& done,
                            int instants) {
  const auto fill = [&](int y, int x0, int x1) {
    for (int x = x0; x < x1; ++x)
      sum_.at(x, y) = static_cast<float>(instants) * background_.at(x, y);
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
  if (!sensor_.has_empty_scene()) finish_background();
  const int instants = settings_.blur_samples;
  renderer::Rect done, region = draw_mirror_image(origin_ns, truth);
  for (int i = 0; i < instants; ++i) {
    // The instants also differ in their position within the pixel, which antialiases the edges.
    const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(instants) - 0.5f;
    std::size_t shots = 0;
    const auto time_ns =
        origin_ns + static_cast<std::int64_t>(at * static_cast<double>(exposure_ns));
    const auto hands = shoot_hands(time_ns, truth, {at, -at}, shots);
    const auto bounds = shoot_face(time_ns, {at, -at}, shots).joined(hands);
    if (!bounds.empty()) region = bounds.grown(sensor_.reach_px()).joined(region);
    region = region.within(camera_.width_px, camera_.height_px);
    start_sum(region, done, i);
    done = region;
    expose(shots, region);
  }
  sensor_.develop(k, sum_.view(), region, instants, faulty_, image);
}

}  // namespace handcast::twin
