// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/pipeline.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include "renderer/correct/deform.hpp"

namespace handcast::renderer {
namespace {

using msg::Stage;

/// A hand with less is as good as not reported: a pose that was repeated, not measured.
constexpr float kLeastConfidence = 0.1f;

LandmarkOracle of_side(const Pipeline::Oracle& oracle, Side side) {
  if (!oracle) return {};
  return [oracle, side](std::int64_t time_ns) { return oracle(side, time_ns); };
}

/// Up to this angle between camera and projector, the hand's outline in the camera's image is about
/// that in the projector's. From the side it is another one, and would leave skin dark and light
/// the wall (docs/lab/experiments.md, "The mask from the side").
constexpr double kMostAside_deg = 12;

/// True if an origin is implausibly later than the arrival. Such a message would make all messages
/// until its origin count as older.
bool is_early(std::int64_t now_ns, std::int64_t origin_ns) {
  constexpr std::int64_t kMost_ns = 50'000'000;  // the map of sensor clocks is not exact
  return origin_ns > now_ns + kMost_ns;
}

}  // namespace

Result<std::unique_ptr<Pipeline>> Pipeline::create(
    const config::Cascade& cascade, const config::Content& content, const config::Hand& hand,
    const calib::Calibration& calibration, const Oracle& oracle, std::unique_ptr<Painter> painter) {
  if (cascade.filter.method == config::FilterMethod::ideal && !oracle)
    return fail(Errc::bad_config,
                "cascade.filter.method = \"ideal\" needs the true landmarks, which only `handcast "
                "simulate` has");
  // On two threads, because a hand takes most of the time of a start. Deferred: on this thread, if
  // there is no other one.
  auto left_loaded = std::async(std::launch::async | std::launch::deferred, [&] {
    return HandPipeline::load(Side::left, cascade, content, hand, calibration,
                              of_side(oracle, Side::left));
  });
  auto right = HandPipeline::load(Side::right, cascade, content, hand, calibration,
                                  of_side(oracle, Side::right));
  auto left = left_loaded.get();
  if (!left) return fail_in("left hand", left.error());
  if (!right) return fail_in("right hand", right.error());
  return std::unique_ptr<Pipeline>(new Pipeline(cascade, content, calibration, std::move(*left),
                                                std::move(*right), std::move(painter)));
}

Pipeline::Passed::Passed() {
  const auto reserve = [](std::size_t most, auto&... all) { (all.reserve(most), ...); };
  reserve(msg::kMaxHands, hands, sought, moved, late, drawn, described, shared);
  reserve(MovingLeastSquares::kMost, grid_from_px, grid_to_px);
}

Pipeline::Pipeline(const config::Cascade& settings, const config::Content& content,
                   const calib::Calibration& calibration, HandPipeline left, HandPipeline right,
                   std::unique_ptr<Painter> painter)
    : settings_(settings),
      projector_(calibration.projector),
      shading_(static_cast<float>(content.shading)),
      screen_{0, 0, calibration.projector.width_px, calibration.projector.height_px},
      both_{std::move(left), std::move(right)},
      is_aside_(calibration.degrees_apart() > kMostAside_deg),
      mask_(settings.mask, calibration, content.smooth),
      late_(registration_of(settings), settings.filter, calibration),
      painter_(std::move(painter), settings.fill, screen_.x1, screen_.y1) {
  if (calibration.projector2) share_.emplace(calibration);
}

void Pipeline::adjust(const config::Cascade& cascade, const config::Content& content) {
  settings_ = cascade;
  shading_ = static_cast<float>(content.shading);
  for (auto& hand : both_) hand.adjust(cascade);
  mask_.adjust(cascade.mask);
  late_.adjust(registration_of(cascade), cascade.filter);
  painter_.adjust(cascade.fill);
}

void Pipeline::aim(const glm::dmat3& pixels) {
  const auto projector = projector_.moved(pixels);
  for (auto& hand : both_) hand.aim(projector);
  mask_.aim(projector);
}

void Pipeline::push(std::int64_t now_ns, const msg::HandPoses& reported) {
  const std::int64_t origin_ns = reported.header.origin_ns;
  if (is_early(now_ns, origin_ns)) return;
  newest_.pose_ns = std::max(newest_.pose_ns, origin_ns);
  const auto poses = sides_.named(
      reported, {both_[0].expected_pose(origin_ns), both_[1].expected_pose(origin_ns)});
  for (HandPipeline& hand : both_)
    if (const msg::HandPose* pose = poses.find(hand.side());
        pose && pose->confidence >= kLeastConfidence)
      hand.push(now_ns, origin_ns, *pose);
}

void Pipeline::push(std::int64_t now_ns, const msg::Landmarks& reported) {
  const std::int64_t origin_ns = reported.header.origin_ns;
  if (is_early(now_ns, origin_ns)) return;
  newest_.landmarks_ns = std::max(newest_.landmarks_ns, origin_ns);
  const auto landmarks = sides_.named(
      reported, {both_[0].expected_landmarks(origin_ns), both_[1].expected_landmarks(origin_ns)});
  for (HandPipeline& hand : both_)
    if (const msg::HandLandmarks* seen = landmarks.find(hand.side()))
      hand.push(now_ns, origin_ns, *seen);
}

Frame Pipeline::render(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera) {
  const Placed placed = place(now_ns, target_ns, camera, true);
  Frame frame;
  frame.target_ns = target_ns;
  frame.made_from = newest_;
  if (!placed.region.empty()) frame.region = placed.region;
  frame.hands = frame_hands();
  frame.foldovers = placed.foldovers;
  painter_.draw(drawing_of(placed), stages_, frame);
  stages_.finish();
  frame.stages = stages_.marks();
  return frame;
}

std::span<const FrameHand> Pipeline::track(std::int64_t now_ns, std::int64_t target_ns,
                                           const TimedImage& camera) {
  place(now_ns, target_ns, camera, false);
  return frame_hands();
}

/// The method: the steps of a frame in their order, except draw and fill.
Pipeline::Placed Pipeline::place(std::int64_t now_ns, std::int64_t target_ns,
                                 const TimedImage& camera, bool is_drawn) {
  stages_.start();
  constexpr std::int64_t kLongest_ns = 250'000'000;  // then the camera is away
  const bool has_image =
      camera && !is_early(now_ns, camera.origin_ns) && now_ns - camera.origin_ns < kLongest_ns;
  const bool is_seen = has_image && (is_drawn ? settings_.fill.method != config::FillMethod::none
                                              : late_.on() && late_.is_new(camera));
  if (is_drawn) {
    newest_.image_id = has_image ? camera.id : 0;
    newest_.image_ns = has_image ? camera.origin_ns : 0;
    was_seen_ = is_seen;
  }

  // If nothing is drawn, the hands are searched where the frame before had them.
  if (is_seen && !is_drawn) see(camera);
  predict(now_ns, target_ns);
  stages_.mark(Stage::predict);
  if (is_seen && is_drawn) see(camera);
  auto& hands = passed_.hands;
  if (was_seen_)
    for (auto& [hand, frame] : hands) hand->dim(frame, target_ns);
  if (late_.on()) {
    for (auto& [hand, frame] : hands) hand->register_motion(frame, late_, target_ns);
    stages_.mark(Stage::registration);
  }

  const auto was_sought = [](const HandInFrame& now, const HandMask::Sought& then) {
    return now.hand->side() == then.side;
  };
  Placed placed{.is_masked =
                    is_seen && !is_aside_ && std::ranges::equal(hands, passed_.sought, was_sought)};
  if (!is_drawn && !placed.is_masked) return placed;
  const bool is_shared = is_drawn && share_;
  for (auto& [hand, frame] : hands) hand->skin(frame, is_drawn ? shading_ : 0, is_shared);
  if (is_shared) share_light();
  stages_.mark(Stage::skin);
  // If nothing is drawn, nothing is warped: the outline is learned from corrected vertices.
  placed.foldovers = correct(is_drawn ? settings_.correct.method : config::CorrectMethod::vertices);
  stages_.mark(Stage::correct, rungs());
  if (!placed.is_masked) {
    placed.region = projected_bounds();
    return placed;
  }
  placed.region = advance_masks();
  learn_outline(target_ns);
  stages_.mark(Stage::advance);
  return placed;
}

void Pipeline::predict(std::int64_t now_ns, std::int64_t target_ns) {
  passed_.hands.clear();
  for (HandPipeline& hand : both_)
    if (auto frame = hand.predict(now_ns, target_ns)) passed_.hands.push_back({&hand, *frame});
}

/// Finds the masks of the hands in an image and registers the hands in it.
void Pipeline::see(const TimedImage& camera) {
  auto& hands = passed_.hands;
  auto& sought = passed_.sought;
  auto& late = passed_.late;
  sought.clear();
  for (const auto& [hand, frame] : hands) sought.push_back(hand->sought(frame, camera.origin_ns));
  mask_.find(camera, sought);
  for (std::size_t h = 0; h < hands.size(); ++h) hands[h].hand->set_shown(mask_.shows(h));
  stages_.mark(Stage::mask);
  if (!late_.on()) return;
  late.clear();
  for (const auto& [hand, frame] : hands)
    if (const auto registered = hand->to_register(frame)) late.push_back(*registered);
  late_.look(mask_.silhouette(camera), late);
}

Rect Pipeline::advance_masks() {
  passed_.moved.clear();
  for (const auto& [hand, frame] : passed_.hands) passed_.moved.push_back(hand->moved(frame));
  return mask_.advance(passed_.moved);
}

/// Moves the projected vertices, and makes the grid if the drawing will be warped. Returns the
/// number of triangles that are turned over.
int Pipeline::correct(config::CorrectMethod method) {
  passed_.is_warped = false;
  if (method == config::CorrectMethod::grid) return correct_by_grid();
  int foldovers = 0;
  if (method == config::CorrectMethod::vertices)
    for (auto& [hand, frame] : passed_.hands) foldovers += hand->correct(frame);
  return foldovers;
}

/// The landmarks that control the grid.
static std::span<const int> control_points(config::GridPoints points) {
  static constexpr std::array<int, kLandmarks> kAll{0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10,
                                                    11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
  // Paired with the Leap joints 1, 5, 11, 19, 27, 35, 9, 17, 25, 33, 41, 7, 15, 23, 31 and 39
  // there.
  static constexpr std::array<int, 16> kReleased{0,  2,  5,  9, 13, 17, 4,  8,
                                                 12, 16, 20, 3, 7,  11, 15, 19};
  if (points == config::GridPoints::all) return kAll;
  return kReleased;
}

/// One grid for all hands. A hand without landmarks adds control points that do not move.
int Pipeline::correct_by_grid() {
  const auto has_landmarks = [](const HandInFrame& each) {
    return each.frame.corrected.has_landmarks;
  };
  auto& hands = passed_.hands;
  if (static_cast<int>(hands.size()) > settings_.correct.grid_hands ||
      std::ranges::none_of(hands, has_landmarks))
    return 0;
  auto &p = passed_.grid_from_px, &q = passed_.grid_to_px;
  p.clear();
  q.clear();
  for (const auto& [hand, frame] : hands)
    for (const int i : control_points(settings_.correct.grid_points)) {
      p.push_back(frame.from_px[i]);
      q.push_back(frame.to_px[i]);
    }
  const auto alpha = static_cast<float>(settings_.correct.alpha);
  make_warp_grid(settings_.correct, screen_, MovingLeastSquares(p, q, alpha), passed_.grid);
  passed_.is_warped = true;
  int foldovers = 0;
  for (auto& [hand, frame] : hands) {
    for (glm::vec2& vertex : frame.skinned->projected_px) vertex = passed_.grid(vertex);
    foldovers += hand->foldovers(frame);
  }
  return foldovers;
}

std::uint32_t Pipeline::rungs() const {
  std::uint32_t detail = 0;
  for (const auto& [hand, frame] : passed_.hands)
    detail = msg::with_rung(detail, hand->side(), frame.corrected.rung);
  return detail;
}

void Pipeline::learn_outline(std::int64_t target_ns) {
  for (std::size_t h = 0; h < passed_.hands.size(); ++h)
    if (mask_.shows(h)) {
      const auto& [hand, frame] = passed_.hands[h];
      hand->learn_outline(frame, target_ns, mask_.in_projector());
    }
}

void Pipeline::share_light() {
  passed_.shared.clear();
  for (const auto& [hand, frame] : passed_.hands) passed_.shared.push_back(hand->shared(frame));
  share_->apply(passed_.shared, beside_);
}

Rect Pipeline::projected_bounds() const {
  Rect bounds;
  for (const auto& [hand, frame] : passed_.hands)
    bounds = bounds.joined(hand->bounds(frame.skinned->projected_px));
  return on_screen(bounds);
}

FrameDrawing Pipeline::drawing_of(const Placed& placed) {
  auto& drawn = passed_.drawn;
  const bool is_warped = passed_.is_warped;
  drawn.clear();
  Rect source;
  for (const auto& [hand, frame] : passed_.hands) {
    if (frame.presence <= 0) continue;
    const Skinned& skinned = *frame.skinned;
    drawn.push_back(hand->drawn(skinned, is_warped ? skinned.seen_px : skinned.projected_px));
    if (is_warped) source = source.joined(hand->bounds(skinned.seen_px));
  }
  return {drawn, placed.region, on_screen(source), is_warped ? &passed_.grid : nullptr,
          placed.is_masked ? mask_.in_projector() : GreyView{}};
}

std::span<const FrameHand> Pipeline::frame_hands() {
  passed_.described.clear();
  int drawn = 0;
  for (const auto& [hand, frame] : passed_.hands) {
    passed_.described.push_back(hand->described(frame));
    if (frame.presence > 0) passed_.described.back().drawn_as = drawn++;
  }
  return passed_.described;
}

}  // namespace handcast::renderer
