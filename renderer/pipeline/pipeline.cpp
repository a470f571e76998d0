// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/pipeline.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include "ipc/base/log.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/predict/plausible_pose.hpp"

namespace handcast::renderer {
namespace {

using msg::Stage;

/// A hand with less is as good as not reported: a pose that was repeated, not measured.
constexpr float kLeastConfidence = 0.1f;

LandmarkOracle of_side(const Pipeline::Oracle& oracle, Side side) {
  if (!oracle) return {};
  return [oracle, side](std::int64_t time_ns) { return oracle(side, time_ns); };
}

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

Pipeline::Pipeline(const config::Cascade& settings, const config::Content& content,
                   const calib::Calibration& calibration, HandPipeline left, HandPipeline right,
                   std::unique_ptr<Painter> painter)
    : settings_(settings),
      camera_from_tracker_(calibration.camera_from_tracker),
      shading_(static_cast<float>(content.shading)),
      screen_{0, 0, calibration.projector_width_px, calibration.projector_height_px},
      both_{std::move(left), std::move(right)},
      mask_(settings.mask, calibration, content.smooth),
      late_(registration_of(settings), settings.filter, calibration),
      painter_(painter ? std::move(painter) : make_cpu_painter(screen_.x1, screen_.y1)) {}

void Pipeline::push(std::int64_t now_ns, const msg::HandPoses& reported) {
  const std::int64_t origin_ns = reported.header.origin_ns;
  if (is_early(now_ns, origin_ns)) return;
  newest_.pose_ns = std::max(newest_.pose_ns, origin_ns);
  const auto poses = sides_.named(
      reported, {both_[0].expected_pose(origin_ns), both_[1].expected_pose(origin_ns)});
  for (HandPipeline& hand : both_)
    if (const msg::HandPose* pose = poses.find(hand.side());
        pose && pose->confidence >= kLeastConfidence && is_plausible(*pose, camera_from_tracker_))
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

std::span<const FrameHand> Pipeline::track(std::int64_t now_ns, std::int64_t target_ns) {
  predict(now_ns, target_ns, expected_image_ns(target_ns));
  if (last_image_) dim(target_ns);
  register_motion(target_ns);
  if (looked_ns_) learn(*std::exchange(looked_ns_, std::nullopt), target_ns);
  return frame_hands();
}

/// Learns from the image of find_masks() as render() does, without a drawing.
void Pipeline::learn(std::int64_t image_ns, std::int64_t target_ns) {
  const auto is_same = [](const HandMask::Expected& then, const HandInFrame& now) {
    return then.side == now.hand->side();
  };
  if (!std::ranges::equal(expected_, hands_, is_same)) return;
  for (auto& [hand, frame] : hands_) {
    hand->skin(frame, 0);
    hand->correct(frame);
  }
  expect(image_ns);
  mask_.advance(expected_);
  learn_outline(target_ns);
  for (auto& [hand, frame] : hands_) frame.skinned.reset();
}

void Pipeline::look(const TimedImage& camera) {
  if (!late_.on() || !camera || !late_.is_new(camera) || is_early(now_ns_, camera.origin_ns))
    return;
  find_masks(camera);
  register_late(camera);
  looked_ns_ = camera.origin_ns;
}

Frame Pipeline::render(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera) {
  stages_.start();
  const bool has_image = camera && !is_early(now_ns, camera.origin_ns);
  newest_.image_id = has_image ? camera.id : 0;
  newest_.image_ns = has_image ? camera.origin_ns : 0;
  const bool is_masked = has_image && settings_.fill.method != config::FillMethod::none;
  last_image_ = is_masked ? std::optional(ImageUse{target_ns, camera.origin_ns}) : std::nullopt;
  predict(now_ns, target_ns, expected_image_ns(target_ns));
  stages_.mark(Stage::predict);

  if (is_masked) {
    find_masks(camera);
    dim(target_ns);
    stages_.mark(Stage::mask);
    register_late(camera);
  }
  register_motion(target_ns);
  if (late_.on()) stages_.mark(Stage::registration);
  for (auto& [hand, frame] : hands_) hand->skin(frame, shading_);
  stages_.mark(Stage::skin);
  const int foldovers = correct();
  stages_.mark(Stage::correct, rungs());
  Rect region;
  if (is_masked) {
    region = advance_masks(camera);
    learn_outline(target_ns);
    stages_.mark(Stage::advance);
  } else {
    region = landing_bounds();
  }

  FillCounts counts = paint(region, is_masked);
  auto device = painter_->device_image();
  View<const std::uint32_t> colour;
  if (!device) colour = painter_->colour();
  if (replace_failed_painter()) {
    device.reset();
    counts = paint(region, is_masked);
    colour = painter_->colour();
  }
  for (const auto& [stage, took_ns] : painter_->device_passes()) stages_.add(stage, took_ns);
  stages_.finish();
  Frame frame;
  frame.target_ns = target_ns;
  frame.made_from = newest_;
  if (!region.empty()) frame.region = region;
  frame.colour = colour;
  frame.hands = frame_hands();
  frame.foldovers = foldovers;
  frame.fill = counts;
  frame.stages = stages_.marks();
  frame.device = device;
  if (!device) add_surface(frame);
  return frame;
}

void Pipeline::add_surface(Frame& frame) {
  if (!shows_surface_ || frame.region.empty()) return;
  frame.uv = painter_->uv();
  frame.surface = painter_->surface();
}

void Pipeline::read_back(Frame& frame) {
  if (frame.colour.data != nullptr) return;
  frame.colour = painter_->colour();
  add_surface(frame);
}

/// The exposure of the image that a frame for `target_ns` can be registered to. The image is
/// assumed to be as old as that of the last frame.
std::optional<std::int64_t> Pipeline::expected_image_ns(std::int64_t target_ns) const {
  if (!last_image_ || !late_.on()) return std::nullopt;
  return target_ns - (last_image_->target_ns - last_image_->origin_ns);
}

void Pipeline::predict(std::int64_t now_ns, std::int64_t target_ns,
                       std::optional<std::int64_t> image_ns) {
  now_ns_ = now_ns;
  hands_.clear();
  for (HandPipeline& hand : both_)
    if (auto frame = hand.predict(now_ns, target_ns, image_ns)) hands_.push_back({&hand, *frame});
}

void Pipeline::expect(std::int64_t image_ns) {
  expected_.clear();
  for (const auto& [hand, frame] : hands_) expected_.push_back(hand->expected(frame, image_ns));
}

void Pipeline::find_masks(const TimedImage& camera) {
  expect(camera.origin_ns);
  mask_.find(camera, expected_);
  for (std::size_t h = 0; h < hands_.size(); ++h) hands_[h].hand->set_shown(mask_.shows(h));
}

void Pipeline::dim(std::int64_t target_ns) {
  for (auto& [hand, frame] : hands_) hand->dim(frame, target_ns);
}

/// Registers the hands in a new image, after find_masks().
void Pipeline::register_late(const TimedImage& camera) {
  if (!late_.on()) return;
  late_hands_.clear();
  for (const auto& [hand, frame] : hands_)
    if (const auto late = hand->to_register(frame)) late_hands_.push_back(*late);
  late_.look(mask_.silhouette(camera), late_hands_);
}

void Pipeline::register_motion(std::int64_t target_ns) {
  if (!late_.on()) return;
  for (auto& [hand, frame] : hands_) hand->register_motion(frame, late_, target_ns);
}

Rect Pipeline::advance_masks(const TimedImage& camera) {
  expect(camera.origin_ns);
  return mask_.advance(expected_);
}

/// Moves the landings, and makes the grid if the drawing will be warped. Returns the number of
/// triangles that are turned over.
int Pipeline::correct() {
  grid_.reset();
  if (settings_.correct.method == config::CorrectMethod::grid) return correct_by_grid();
  int foldovers = 0;
  if (settings_.correct.method == config::CorrectMethod::vertices)
    for (auto& [hand, frame] : hands_) foldovers += hand->correct(frame);
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
  if (static_cast<int>(hands_.size()) > settings_.correct.grid_hands ||
      std::ranges::none_of(
          hands_, [](const HandInFrame& each) { return each.frame.corrected.has_landmarks; }))
    return 0;
  std::vector<glm::vec2> p, q;
  for (const auto& [hand, frame] : hands_) {
    const LandmarkPoints from = hand->from_px(frame), to = hand->to_px(frame);
    for (const int i : control_points(settings_.correct.grid_points)) {
      p.push_back(from[i]);
      q.push_back(to[i]);
    }
  }
  grid_ = make_warp_grid(settings_.correct, screen_,
                         MovingLeastSquares(p, q, static_cast<float>(settings_.correct.alpha)));
  int foldovers = 0;
  for (auto& [hand, frame] : hands_) {
    for (glm::vec2& landing : frame.skinned->landings_px) landing = (*grid_)(landing);
    foldovers += hand->foldovers(frame);
  }
  return foldovers;
}

std::uint32_t Pipeline::rungs() const {
  std::uint32_t detail = 0;
  for (const auto& [hand, frame] : hands_)
    detail = msg::with_rung(detail, hand->side(), frame.corrected.rung);
  return detail;
}

void Pipeline::learn_outline(std::int64_t target_ns) {
  for (std::size_t h = 0; h < hands_.size(); ++h)
    if (mask_.shows(h))
      hands_[h].hand->learn_outline(hands_[h].frame, target_ns, mask_.in_projector());
}

Rect Pipeline::landing_bounds() const {
  Rect bounds;
  for (const auto& [hand, frame] : hands_)
    bounds = bounds.joined(hand->bounds(frame.skinned->landings_px));
  return on_screen(bounds);
}

FillCounts Pipeline::paint(const Rect& region, bool is_masked) {
  if (region.empty()) return {};
  drawn_.clear();
  Rect source;
  for (const auto& [hand, frame] : hands_) {
    if (frame.presence <= 0) continue;
    const Skinned& skinned = *frame.skinned;
    drawn_.push_back(hand->drawn(skinned, grid_ ? skinned.seen_px : skinned.landings_px));
    source = source.joined(hand->bounds(skinned.seen_px));
  }
  source = on_screen(source);
  const bool is_warped = grid_ && !source.empty();
  painter_->draw(drawn_, is_warped ? source : region);
  stages_.mark(Stage::draw);
  if (is_warped) {
    painter_->warp(*grid_, source, region);
    stages_.mark(Stage::warp);
  }
  if (!is_masked) return {};
  const FillCounts counts = painter_->fill(mask_.in_projector(), settings_.fill, region);
  stages_.mark(Stage::fill);
  return counts;
}

/// Returns true if the frame must be painted again.
bool Pipeline::replace_failed_painter() {
  const auto failure = painter_->failure();
  if (!failure) return false;
  log::warning("{}; drawing with cpu until the next start", failure->what);
  painter_ = make_cpu_painter(screen_.x1, screen_.y1);
  return true;
}

std::span<const FrameHand> Pipeline::frame_hands() {
  frame_hands_.clear();
  int drawn = 0;
  for (const auto& [hand, frame] : hands_) {
    frame_hands_.push_back(hand->described(frame));
    if (frame.presence > 0) frame_hands_.back().drawn_as = drawn++;
  }
  return frame_hands_;
}

}  // namespace handcast::renderer
