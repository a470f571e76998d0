// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/scene/scene_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "calib/sub_frames.hpp"
#include "ipc/msg/largest_images.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "renderer/mask/hint.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::preview {

Result<World> load_world(const config::Rig& rig, config::Viewpoint projector) {
  auto calibration = calib::load_calibration(rig.calibration, rig.projector, rig.projector2);
  if (!calibration) return tl::make_unexpected(std::move(calibration.error()));
  if (projector == config::Viewpoint::second && !calibration->projector2)
    return fail(Errc::bad_config, "the rig has no second projector (projector2.backend)");
  World world{.calibration = calib::at_projector(std::move(*calibration), projector),
              .mask = rig.cascade.mask,
              .predict = rig.cascade.predict,
              .hands = {},
              .brightness = config::rig_at_projector(rig, projector).projector.brightness};
  for (const auto& [side, file] :
       {std::pair{msg::Side::left, rig.hand.left}, std::pair{msg::Side::right, rig.hand.right}}) {
    auto mesh = renderer::load_hand_or_default(file, side);
    if (!mesh) return tl::make_unexpected(std::move(mesh.error()));
    world.hands[static_cast<std::size_t>(side)] = std::move(*mesh);
  }
  return world;
}

namespace {

using renderer::Similarity;

constexpr std::array kSides{msg::Side::left, msg::Side::right};

bool is_sound(const msg::CameraFrame& frame) {
  return frame.width_px > 0 && frame.height_px > 0 &&
         frame.width_px <= msg::kLargestCameraWidth_px &&
         frame.height_px <= msg::kLargestCameraHeight_px;
}

renderer::Image<std::uint8_t> image_of(const msg::CameraFrame& frame) {
  renderer::Image<std::uint8_t> image(static_cast<int>(frame.width_px),
                                      static_cast<int>(frame.height_px));
  std::memcpy(image.row(0), frame.pixels(), image.pixels().size());
  return image;
}

Similarity inverse(const Similarity& move) {
  const float square = move.cosine * move.cosine + move.sine * move.sine;
  Similarity back{move.cosine / square, -move.sine / square, glm::vec2(0)};
  back.shift = -back(move.shift);
  return back;
}

glm::vec2 mean_of(const std::vector<glm::vec2>& points) {
  glm::vec2 sum(0);
  for (const auto point : points) sum += point;
  return sum / static_cast<float>(points.size());
}

constexpr int kMargin_px = 64;  ///< more than a hand moves between image and light

/// The smallest rectangle of whole pixels around points, and kMargin_px more. Empty without points.
renderer::Rect around(const std::vector<glm::vec2>& points) {
  renderer::Rect bounds;
  for (const auto point : points) {
    const auto px = glm::ivec2(glm::clamp(point, -1e6f, 1e6f));
    bounds = bounds.joined({px.x, px.y, px.x + 1, px.y + 1});
  }
  return bounds.empty() ? bounds : bounds.grown(kMargin_px);
}

/// The part of the image that shows the hands or their light.
renderer::Rect busy_part(const std::vector<ShownHand>& hands, const msg::Projection& projection,
                         const FromCamera& from_camera) {
  renderer::Rect part;
  for (const auto& hand : hands) part = part.joined(around(hand.joints_px));
  const double left = projection.region_x_px, top = projection.region_y_px,
               right = left + projection.region_width_px,
               bottom = top + projection.region_height_px;
  std::vector<glm::vec2> corners;
  for (const auto corner : {glm::dvec2(left, top), glm::dvec2(right, top), glm::dvec2(left, bottom),
                            glm::dvec2(right, bottom)})
    if (const auto px = from_camera.image_px_of(corner)) corners.push_back(*px);
  if (projection.region_width_px > 0) part = part.joined(around(corners));
  return part;
}

/// The pixel of an image at a position; `none` outside.
template <class Pixel>
Pixel pixel_at(const renderer::Image<Pixel>& image, glm::vec2 at, Pixel none) {
  if (!(at.x > -0.5f && at.y > -0.5f)) return none;
  const auto x = static_cast<int>(std::min(at.x + 0.5f, 1e6f)),
             y = static_cast<int>(std::min(at.y + 0.5f, 1e6f));
  return x < image.width() && y < image.height() ? image.at(x, y) : none;
}

Region region_of(bool is_hand, bool is_drawn) {
  return static_cast<Region>((is_hand ? 2 : 0) + (is_drawn ? 1 : 0));
}
static_assert(static_cast<int>(Region::lit) == 3 && static_cast<int>(Region::unlit) == 2);

float across(const ForearmCut& cut, glm::vec2 px) {
  const auto from = px - cut.wrist;
  return std::abs(from.y * cut.to_elbow.x - from.x * cut.to_elbow.y);
}

/// Empty if the hand is outside the image.
std::optional<ForearmCut> cut_of(const World& world, const renderer::HandMask::Sought& hand) {
  const auto owned = renderer::make_hint(world.calibration, world.mask, *hand.then, hand.offset_px,
                                         hand.has_landmarks);
  if (!owned) return std::nullopt;
  constexpr float kSkin_px = 24;  // from the joints to the edge of the drawn hand
  ForearmCut cut{owned->wrist_px, owned->to_elbow};
  for (const auto joint : owned->seeds_px)
    cut.half_width = std::max(cut.half_width, across(cut, joint) + kSkin_px);
  return cut;
}

}  // namespace

SceneMaker::SceneMaker(std::optional<World> world) : world_(std::move(world)) {
  if (!world_) return;
  hands_.emplace(world_->predict, world_->calibration);
  mask_.emplace(world_->mask, world_->calibration);
  from_camera_.emplace(world_->calibration);
}

void SceneMaker::push(const msg::HandPoses& poses) {
  if (hands_) hands_->push(poses);
}

void SceneMaker::push(const msg::Landmarks& landmarks) {
  if (hands_) hands_->push(landmarks);
}

bool SceneMaker::fits(const msg::CameraFrame& frame) const {
  const auto& camera = world_->calibration.camera;
  return std::cmp_equal(frame.width_px, camera.width_px) &&
         std::cmp_equal(frame.height_px, camera.height_px);
}

void SceneMaker::add_hands(const msg::CameraFrame& frame, Scene& scene) const {
  for (const auto side : kSides)
    if (auto hand = hands_->at(side, sane_ns(frame.header.origin_ns)))
      scene.hands.push_back(std::move(*hand));
}

std::vector<SceneMaker::Motion> SceneMaker::motions(const Scene& scene, std::int64_t image_ns,
                                                    std::int64_t light_ns) const {
  std::vector<Motion> motions;
  for (const auto& hand : scene.hands) {
    const auto move = hands_->motion(hand.side, image_ns, light_ns);
    if (!move || hand.joints_px.empty()) continue;
    motions.push_back({hand.side, mean_of(hand.joints_px), *move, inverse(*move)});
  }
  return motions;
}

void SceneMaker::find_mask(const msg::CameraFrame& frame) {
  const renderer::TimedImage image{
      {frame.pixels(), static_cast<int>(frame.width_px), static_cast<int>(frame.height_px),
       static_cast<int>(frame.width_px)},
      sane_ns(frame.header.origin_ns),
      frame.header.frame_id};
  std::vector<renderer::HandMask::Sought> sought;
  for (const auto side : kSides) {
    const auto pose = hands_->pose_at(side, image.origin_ns);
    const auto posed = pose ? renderer::project(world_->calibration, *pose) : std::nullopt;
    if (!posed) continue;
    const auto offset_px = hands_->offset_at(side, image.origin_ns);
    sought.push_back(
        {side, posed, offset_px.value_or(renderer::LandmarkPoints{}), offset_px.has_value()});
    if (const auto cut = cut_of(*world_, sought.back())) cuts_.push_back(*cut);
  }
  if (sought.empty()) return;
  mask_->find(image, sought);
  hand_px_ = mask_->silhouette(image).mask;
}

/// True for what the mask takes for an arm: the drawn hand reaches farther than the mask.
bool SceneMaker::is_forearm(glm::vec2 px) const {
  return std::ranges::any_of(cuts_, [px](const ForearmCut& cut) {
    return glm::dot(px - cut.wrist, cut.to_elbow) > 0 && across(cut, px) < cut.half_width;
  });
}

/// Their joints are where they are at the time of the light.
void SceneMaker::place_hands(const Scene& scene, const std::vector<Motion>& motions) {
  std::vector<glm::vec3> joints;
  for (const auto& motion : motions) {
    const auto& hand = *std::ranges::find(scene.hands, motion.side, &ShownHand::side);
    for (std::size_t i = 0; i < hand.joints_px.size(); ++i)
      joints.emplace_back(motion.to_light(hand.joints_px[i]), hand.depths_m[i]);
  }
  from_camera_->place(std::move(joints));
}

void SceneMaker::add_light(const msg::Projection& projection, const std::vector<Motion>& motions,
                           Scene& scene) {
  const auto covered = coverage(projection, world_->hands);
  const int width = scene.camera.width(), height = scene.camera.height();
  scene.light_on_camera = renderer::Texture(width, height);
  if (hand_px_.data) scene.regions = renderer::Image<std::uint8_t>(width, height);
  const auto part = busy_part(scene.hands, projection, *from_camera_).within(width, height);
  for (int y = part.y0; y < part.y1; ++y)
    for (int x = part.x0; x < part.x1; ++x) {
      const glm::vec2 px(x, y);
      const auto nearest = std::ranges::min_element(
          motions, {}, [px](const Motion& motion) { return glm::distance(px, motion.centre_px); });
      const auto then = nearest == motions.end() ? px : nearest->to_light(px);
      const auto lit_px = (*from_camera_)(then);
      scene.light_on_camera.at(x, y) = pixel_at(scene.light, lit_px, 0u);
      if (!hand_px_.data) continue;
      const bool is_hand = hand_px_.at(x, y) != 0;
      const bool is_drawn = pixel_at(covered, lit_px, std::uint8_t{0}) != 0;
      const auto region = region_of(is_hand, is_drawn && (is_hand || !is_forearm(px)));
      scene.regions.at(x, y) = static_cast<std::uint8_t>(region);
      ++scene.region_px[static_cast<std::size_t>(region)];
    }
  if (hand_px_.data)
    scene.region_px[static_cast<std::size_t>(region_of(false, false))] +=
        scene.regions.pixels().size() - static_cast<std::size_t>(part.width()) * part.height();
}

void SceneMaker::add_drawing(const msg::Projection& projection, const std::vector<Motion>& motions,
                             Scene& scene) const {
  for (std::size_t i = 0; i < std::min<std::size_t>(projection.hand_count, projection.hands.size());
       ++i) {
    const auto& hand = projection.hands[i];
    const auto motion = std::ranges::find(motions, hand.side, &Motion::side);
    const auto to_image = motion == motions.end() ? Similarity{} : motion->to_image;
    for (const auto& [from, to] : visible_edges(hand, world_->hands, *from_camera_))
      scene.drawing.emplace_back(to_image(from), to_image(to));
  }
}

Scene SceneMaker::make(const msg::CameraFrame* frame, const msg::Projection* projection) {
  Scene scene;
  hand_px_ = {};
  cuts_.clear();
  if (projection && !preview::is_sound(*projection)) {
    scene.missing.emplace_back("the light is left out: its size makes no sense");
    projection = nullptr;
  }
  if (frame && !is_sound(*frame)) {
    scene.missing.emplace_back("the image is left out: its size makes no sense");
    frame = nullptr;
  }
  if (projection) {
    scene.brightness = world_ ? world_->brightness : 1;
    scene.light = whole_light(*projection, scene.brightness);
    scene.light_id = projection->header.frame_id;
  }
  if (!frame) return scene;
  scene.camera = image_of(*frame);
  scene.image_id = frame->header.frame_id;
  scene.exposure_ns = frame->exposure_ns;
  if (!world_) return scene;
  if (!msg::check_calibration(*frame, world_->calibration.id)) {
    scene.missing.emplace_back("nothing is drawn on the image: it belongs to another calibration");
    return scene;
  }
  if (!fits(*frame)) {
    scene.missing.push_back(fmt::format(
        "nothing is drawn on the image: it has {}x{} px, and the calibration is for {}x{} px",
        frame->width_px, frame->height_px, world_->calibration.camera.width_px,
        world_->calibration.camera.height_px));
    return scene;
  }
  add_hands(*frame, scene);
  find_mask(*frame);
  if (!projection) return scene;
  const auto moves =
      motions(scene, sane_ns(frame->header.origin_ns), sane_ns(projection->target_ns));
  place_hands(scene, moves);
  add_light(*projection, moves, scene);
  add_drawing(*projection, moves, scene);
  return scene;
}

}  // namespace handcast::preview
