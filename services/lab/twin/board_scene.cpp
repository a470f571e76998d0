// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/board_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/clones.hpp"
#include "services/lab/twin/background.hpp"
#include "services/lab/twin/true_geometry.hpp"

namespace handcast::twin {
namespace {

/// Brightness of white paper relative to skin. Chosen: with the default gain it does not saturate
/// at the nearest place.
constexpr float kWhite = 0.75f;
constexpr double kTable_m = 1;
constexpr int kGrid_px = 8;  ///< spacing of the rays that look for the board
/// Positions of samples relative to the middle of a pixel, px. Each is used with its mirror image,
/// so that no instant of the exposure is off the middle; both are a rotated grid.
constexpr std::array<glm::dvec2, 2> kWithinPixel{{{0.125, 0.375}, {0.375, -0.125}}};

glm::dmat3 shift(const glm::dvec2& by) { return {1, 0, 0, 0, 1, 0, by.x, by.y, 1}; }
glm::dmat3 scale(double by) { return {by, 0, 0, 0, by, 0, 0, 0, 1}; }

glm::dvec2 apply(const glm::dmat3& homography, const glm::dvec2& ray) {
  const auto mapped = homography * glm::dvec3(ray, 1);
  return glm::dvec2(mapped) / mapped.z;
}

/// Maps rays (x, y, 1) to places on the plane of a board, m.
glm::dmat3 board_from_ray(const glm::dmat4& camera_from_board) {
  return glm::inverse(glm::dmat3(camera_from_board[0], camera_from_board[1], camera_from_board[3]));
}

BoardOutline outline_of(const FlatPicture& picture) {
  return {picture.on_board_m({-0.5, -0.5}),
          picture.on_board_m({picture.width_px - 0.5, picture.height_px - 0.5})};
}

/// Sets the lamp's light along a row of rays on the plane at the distance `offset` whose normal
/// points away from the camera.
HANDCAST_CLONES
void lamp_on_row(const float* ray_x, const float* ray_y, glm::vec3 normal, float offset,
                 float* lamp, int count) {
  for (int i = 0; i < count; ++i) {
    const glm::vec3 ray(ray_x[i], ray_y[i], 1);
    lamp[i] = lamp_on(ray * (offset / glm::dot(normal, ray)), -normal, 0);
  }
}

HANDCAST_CLONES
void add_projector(const float* shine, float leak, float* lamp, int count) {
  for (int i = 0; i < count; ++i) lamp[i] *= 1 + leak * shine[i];
}

HANDCAST_CLONES
void add_sample(const float* grey, const float* inside, const float* lamp, float sun,
                float* reflected, float* covered, int count) {
  for (int i = 0; i < count; ++i) {
    reflected[i] += grey[i] * (lamp[i] + sun);
    covered[i] += inside[i];
  }
}

HANDCAST_CLONES
void cover_table(const float* reflected, const float* covered, const float* white, float weight,
                 float* out, int count) {
  for (int i = 0; i < count; ++i)
    out[i] += weight * (reflected[i] * white[i] - covered[i] * out[i]);
}

HANDCAST_CLONES
void light_table(const float* table, const float* shine, float leak, float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] += leak * shine[i] * table[i];
}

/// The cameras through whose images a person moves the board, and the pose of the first of them:
/// from the space of the rig's first camera.
struct Viewers {
  std::vector<BoardViewer> cameras;
  glm::dmat4 from_first{1};
};

Viewers viewers_of(config::TwinPropViews views, const calib::Calibration& rig) {
  const BoardViewer first{rig.camera};
  if (views == config::TwinPropViews::first || !rig.camera2) return {{first}};
  const auto& second = *rig.camera2;
  if (views == config::TwinPropViews::second) return {{{second.camera}}, second.from_camera};
  return {{first, {second.camera, second.from_camera}}};
}

}  // namespace

BoardScene::BoardScene(const config::Twin& settings, const TrueGeometry& geometry,
                       const SceneView& view, const FlatPicture& picture)
    : settings_(settings.image),
      geometry_(geometry),
      view_(view),
      metres_per_px_(picture.metres_per_px),
      origin_px_(picture.origin_px),
      held_(viewers_of(settings.prop.views, geometry.calibration()).cameras, outline_of(picture),
            settings.seed, settings.prop.hold_s),
      view_from_held_(
          view.from_first *
          glm::inverse(viewers_of(settings.prop.views, geometry.calibration()).from_first)),
      levels_(make_levels(
          {picture.pixels.data(), picture.width_px, picture.height_px, picture.width_px})),
      light_on_table_(light_from_ray(glm::translate(glm::dmat4(1), {0, 0, kTable_m}))),
      sensor_(settings.image, view.seed, view.camera.width_px) {
  const calib::CameraModel& camera = view_.camera;
  const Random clutter(settings.seed, Stream::image_clutter);
  background_ = make_background(settings_, camera, clutter);
  auto lamp_alone = settings_;
  lamp_alone.sunlight = 0;
  table_ = make_background(lamp_alone, camera, clutter);
  look_through_lens(camera);
  sensor_.set_empty_scene(background_);
  sum_ = renderer::Image<float>(camera.width_px, camera.height_px);
  for (auto* row : {&grey_, &inside_, &shine_, &lamp_, &reflected_, &covered_})
    row->resize(static_cast<std::size_t>(camera.width_px));
}

void BoardScene::look_through_lens(const calib::CameraModel& camera) {
  ray_x_ = ray_y_ = white_ = renderer::Image<float>(camera.width_px, camera.height_px);
  const auto gain = static_cast<float>(settings_.gain);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const auto px = camera.undistort({x, y});
      ray_x_.at(x, y) = static_cast<float>((px.x - camera.cx_px) / camera.fx_px);
      ray_y_.at(x, y) = static_cast<float>((px.y - camera.cy_px) / camera.fy_px);
      white_.at(x, y) =
          kWhite * gain * vignette_at(camera, static_cast<float>(x), static_cast<float>(y));
    }
}

glm::dmat4 BoardScene::camera_from_board(std::int64_t time_ns) const {
  return view_from_held_ * held_.camera_from_board(ns_to_seconds(time_ns));
}

/// Maps rays to the projector pixels that light the plane z = 0 of `camera_from_plane`: a
/// homography, which four rays determine.
glm::dmat3 BoardScene::light_from_ray(const glm::dmat4& camera_from_plane) const {
  const glm::dvec3 normal(camera_from_plane[2]), on_plane(camera_from_plane[3]);
  const auto first_from_view = glm::inverse(view_.from_first);
  const std::array<glm::dvec2, 4> rays{{{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}};
  std::array<glm::dvec2, 4> lights;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 ray(rays[i], 1);
    const glm::dvec3 lit_m = ray * glm::dot(normal, on_plane) / glm::dot(normal, ray);
    lights[i] = geometry_.to_projector(glm::dvec3(first_from_view * glm::dvec4(lit_m, 1)));
  }
  return homography(rays, lights);
}

/// Chooses the level whose pixels are half to just as large as those of the image.
void BoardScene::take_samples(std::int64_t origin_ns, std::int64_t exposure_ns) {
  const calib::CameraModel& camera = view_.camera;
  camera_from_board_ = camera_from_board(origin_ns);
  light_on_board_ = light_from_ray(camera_from_board_);
  const auto metres_per_image_px = camera_from_board_[3].z / camera.fx_px;
  level_ = std::clamp(static_cast<int>(std::log2(metres_per_image_px / metres_per_px_)), 0,
                      static_cast<int>(levels_.size()) - 1);
  const auto level_from_board = shift({-0.5, -0.5}) * scale(std::ldexp(1, -level_)) *
                                shift(origin_px_ + 0.5) * scale(1 / metres_per_px_);
  const int instants = settings_.blur_samples, pairs = std::max(2, instants);
  samples_.clear();
  for (int i = 0; i < pairs; ++i) {
    const double at = (std::min(i, instants - 1) + 0.5) / instants - 0.5;
    const auto pose = camera_from_board(
        origin_ns + static_cast<std::int64_t>(at * static_cast<double>(exposure_ns)));
    const auto picture_from_ray = level_from_board * board_from_ray(pose);
    const auto within_px = kWithinPixel[static_cast<std::size_t>(i % 2)];
    for (const double sign : {-1.0, 1.0}) {
      const auto to_sample = sign * within_px / glm::dvec2(camera.fx_px, camera.fy_px);
      samples_.emplace_back(picture_from_ray * shift(to_sample));
    }
  }
}

/// Columns that contain the board in all samples near row `y` of the image.
renderer::Rect BoardScene::board_near(int y) const {
  const auto& level = levels_[static_cast<std::size_t>(level_)];
  // Two steps of the grid on the board, so that no corner is between the rays.
  const double margin = 2 * kGrid_px * camera_from_board_[3].z / view_.camera.fx_px /
                        metres_per_px_ / std::ldexp(1, level_);
  renderer::Rect near;
  for (int x = 0; x < sum_.width(); x += kGrid_px)
    for (const auto& picture_from_ray : {samples_.front(), samples_.back()}) {
      const auto px = apply(picture_from_ray, {ray_x_.at(x, y), ray_y_.at(x, y)});
      if (px.x > -margin && px.y > -margin && px.x < level.width() + margin &&
          px.y < level.height() + margin)
        near = near.joined({x - kGrid_px, y, x + kGrid_px, y + 1});
    }
  return near;
}

/// Sets bands_; returns a rectangle that contains them.
renderer::Rect BoardScene::find_board() {
  renderer::Rect all, above = board_near(0);
  bands_.clear();
  for (int y = 0; y < sum_.height(); y += kGrid_px) {
    const auto below = board_near(std::min(y + kGrid_px, sum_.height() - 1));
    auto band = above.joined(below);
    if (!band.empty()) band = {band.x0, y, band.x1, y + kGrid_px};
    bands_.push_back(band.within(sum_.width(), sum_.height()));
    all = all.joined(bands_.back());
    above = below;
  }
  return all;
}

/// Draws row `y` of what is behind the board.
void BoardScene::draw_table(int y, const renderer::Rect& region, bool lit) {
  const int x0 = region.x0, width = region.width();
  std::copy_n(background_.row(y) + x0, width, sum_.row(y) + x0);
  if (!lit) return;
  light_.sample(light_on_table_, ray_x_.row(y) + x0, ray_y_.row(y) + x0, width, shine_.data(),
                inside_.data());
  light_table(table_.row(y) + x0, shine_.data(), static_cast<float>(settings_.leak),
              sum_.row(y) + x0, width);
}

/// Draws row `y` of the board over the table, in the columns of `board`.
void BoardScene::draw_board(int y, const renderer::Rect& board, bool lit) {
  const int x0 = board.x0, width = board.width();
  const float *ray_x = ray_x_.row(y) + x0, *ray_y = ray_y_.row(y) + x0;
  const glm::vec3 normal(camera_from_board_[2]);
  const float sun = static_cast<float>(settings_.sunlight) * facing(-glm::dot(normal, to_sun()), 0);
  lamp_on_row(ray_x, ray_y, normal, glm::dot(normal, glm::vec3(camera_from_board_[3])),
              lamp_.data(), width);
  if (lit) {
    light_.sample(light_on_board_, ray_x, ray_y, width, shine_.data(), inside_.data());
    add_projector(shine_.data(), static_cast<float>(settings_.leak), lamp_.data(), width);
  }
  for (auto* sum : {&reflected_, &covered_}) std::fill_n(sum->begin(), width, 0.0f);
  for (const glm::mat3& picture_from_ray : samples_) {
    levels_[static_cast<std::size_t>(level_)].sample(picture_from_ray, ray_x, ray_y, width,
                                                     grey_.data(), inside_.data());
    add_sample(grey_.data(), inside_.data(), lamp_.data(), sun, reflected_.data(), covered_.data(),
               width);
  }
  cover_table(reflected_.data(), covered_.data(), white_.row(y) + x0,
              1 / static_cast<float>(samples_.size()), sum_.row(y) + x0, width);
}

void BoardScene::draw(std::uint64_t k, std::int64_t origin_ns, std::int64_t exposure_ns,
                      const Light* light, renderer::View<std::uint8_t> image) {
  const bool lit = light && settings_.leak > 0;
  if (lit) light_.assign({light->grey, light->width_px, light->height_px, light->width_px});
  take_samples(origin_ns, exposure_ns);
  const auto board = find_board();
  const renderer::Rect all{0, 0, sum_.width(), sum_.height()};
  const auto region = lit ? all : board.grown(sensor_.reach_px()).overlap(all);
  for (int y = region.y0; y < region.y1; ++y) {
    draw_table(y, region, lit);
    const auto& band = bands_[static_cast<std::size_t>(y / kGrid_px)];
    if (!band.empty()) draw_board(y, band, lit);
  }
  sensor_.develop(k, sum_.view(), region, 1, settings_.fault.holds(ns_to_seconds(origin_ns)),
                  image);
}

}  // namespace handcast::twin
