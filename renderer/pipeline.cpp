#include "renderer/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "renderer/cascade/mask.hpp"
#include "renderer/pipeline/hand_surface.hpp"
#include "renderer/pipeline/hand_track.hpp"
#include "renderer/pipeline/hint.hpp"
#include "renderer/pipeline/stage_clock.hpp"

namespace handcast::renderer {
namespace {

using msg::Stage;

/// Bounds of what a similarity takes into `region`.
Rect moved_back(const Rect& region, const Similarity& move) {
  const glm::mat2 turn(glm::vec2(move.cosine, move.sine), glm::vec2(-move.sine, move.cosine));
  const glm::mat2 back = glm::inverse(turn);
  glm::vec2 low(1e6f), high(-1e6f);
  for (const glm::vec2 corner : {glm::vec2(region.x0, region.y0), glm::vec2(region.x1, region.y0), glm::vec2(region.x0, region.y1),
                                 glm::vec2(region.x1, region.y1)}) {
    const glm::vec2 there = back * (corner - move.shift);
    low = glm::min(low, there);
    high = glm::max(high, there);
  }
  return {static_cast<int>(std::floor(low.x)), static_cast<int>(std::floor(low.y)), static_cast<int>(std::ceil(high.x)),
          static_cast<int>(std::ceil(high.y))};
}

LandmarkOracle of_side(const Pipeline::Oracle& oracle, Side side) {
  if (!oracle) return {};
  return [oracle, side](std::int64_t time_ns) { return oracle(side, time_ns); };
}

class Cascade final : public Pipeline {
 public:
  Cascade(const config::Cascade& settings, const config::Content& content, const calib::Calibration& calibration, HandSurface left,
          HandSurface right, const Oracle& oracle)
      : settings_(settings),
        shading_(static_cast<float>(content.shading)),
        calibration_(calibration),
        tracks_{HandTrack(settings, calibration, of_side(oracle, Side::left)),
                HandTrack(settings, calibration, of_side(oracle, Side::right))},
        surfaces_{std::move(left), std::move(right)},
        mask_finder_(settings.mask),
        lookup_(calibration),
        projector_mask_(calibration.projector_width_px, calibration.projector_height_px),
        painter_(make_cpu_painter(calibration.projector_width_px, calibration.projector_height_px)) {}

  void push(std::int64_t now_ns, const msg::HandPoses& poses) override {
    for (const Side side : {Side::left, Side::right})
      if (const msg::HandPose* pose = poses.find(side)) {
        track_of(side).push(now_ns, poses.header.origin_ns, *pose);
        surfaces_[static_cast<std::size_t>(side)].learn(poses.header.origin_ns, *pose);
      }
  }

  void push(std::int64_t now_ns, const msg::Landmarks& landmarks) override {
    for (const Side side : {Side::left, Side::right})
      if (const msg::HandLandmarks* seen = landmarks.find(side)) track_of(side).push(now_ns, landmarks.header.origin_ns, *seen);
  }

  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns) override {
    predict(now_ns, target_ns);
    return frame_hands_;
  }

  Frame render(std::int64_t now_ns, std::int64_t target_ns, GreyView camera, std::int64_t camera_ns) override {
    stages_.start();
    predict(now_ns, target_ns);
    stages_.mark(Stage::predict);
    skin_hands();
    stages_.mark(Stage::skin);
    const int foldovers = correct();
    stages_.mark(Stage::correct);

    const bool masked = settings_.fill.method != "none" && camera.data != nullptr;
    Rect region = landing_bounds();
    if (masked) {
      region = find_mask(camera, camera_ns);
      learn_widths(target_ns);
      stages_.mark(Stage::mask);
    }
    const FillCounts counts = paint(region, masked);
    stages_.finish();
    return {target_ns, region.empty() ? Rect{} : region, painter_->colour(), frame_hands_, foldovers, counts, stages_.marks()};
  }

 private:
  HandTrack& track_of(Side side) { return tracks_[static_cast<std::size_t>(side)]; }
  HandSurface& surface_of(const FrameHand& hand) { return surfaces_[static_cast<std::size_t>(hand.side)]; }
  Rect on_screen(const Rect& region) const { return region.within(calibration_.projector_width_px, calibration_.projector_height_px); }

  void predict(std::int64_t now_ns, std::int64_t target_ns) {
    frame_hands_.clear();
    tracked_.clear();
    for (const Side side : {Side::left, Side::right}) {
      const auto tracked = track_of(side).at(now_ns, target_ns);
      if (!tracked) continue;
      tracked_.push_back(*tracked);
      frame_hands_.push_back({side, tracked->tracker, tracked->corrected, tracked->has_landmarks, {}});
    }
  }

  void skin_hands() {
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      HandSurface& surface = surface_of(frame_hands_[h]);
      surface.pose(tracked_[h].pose, settings_.skin, calibration_, shading_);
      frame_hands_[h].landings = surface.landings_px();
    }
  }

  /// Moves the landings (and makes the grid, where the drawing is to be warped). Returns what was turned over.
  int correct() {
    grid_.reset();
    if (settings_.correct.method == "vertices") return correct_by_vertices();
    if (settings_.correct.method == "grid") return correct_by_grid();
    return 0;
  }

  LandmarkPoints to_projector(const LandmarkPoints& camera_px) const {
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i) points[i] = calibration_.to_projector(camera_px[i]);
    return points;
  }

  int correct_by_vertices() {
    int foldovers = 0;
    for (const FrameHand& hand : frame_hands_) {
      if (!hand.has_landmarks) continue;
      HandSurface& surface = surface_of(hand);
      correct_vertices(settings_.correct, surface.mesh(), to_projector(hand.tracker), to_projector(hand.corrected), surface.landings_px());
      foldovers += surface.untangle();
    }
    return foldovers;
  }

  /// One grid for all hands; a hand without landmarks holds its place in it.
  int correct_by_grid() {
    if (std::none_of(frame_hands_.begin(), frame_hands_.end(), [](const FrameHand& hand) { return hand.has_landmarks; })) return 0;
    std::vector<glm::vec2> p, q;
    for (const FrameHand& hand : frame_hands_) {
      const LandmarkPoints from = to_projector(hand.tracker), to = to_projector(hand.corrected);
      p.insert(p.end(), from.begin(), from.end());
      q.insert(q.end(), to.begin(), to.end());
    }
    const Rect screen{0, 0, calibration_.projector_width_px, calibration_.projector_height_px};
    grid_ = make_warp_grid(settings_.correct, screen, MovingLeastSquares(p, q, static_cast<float>(settings_.correct.alpha)));
    for (const FrameHand& hand : frame_hands_)
      for (glm::vec2& landing : surface_of(hand).landings_px()) landing = (*grid_)(landing);
    return grid_->foldovers();
  }

  Rect landing_bounds() {
    Rect bounds;
    for (const FrameHand& hand : frame_hands_) {
      const HandSurface& surface = surface_of(hand);
      bounds = bounds.joined(surface.bounds(surface.landings_px()));
    }
    return on_screen(bounds);
  }

  /// The hands in the camera image, as the projector would see them. Returns the part of the projector's image that has any.
  Rect find_mask(GreyView camera, std::int64_t camera_ns) {
    if (camera_mask_.width() != camera.width || camera_mask_.height() != camera.height) {
      camera_mask_ = Image<std::uint8_t>(camera.width, camera.height);
      written_ = {};
    }
    for (int y = written_.y0; y < written_.y1; ++y)
      std::memset(camera_mask_.row(y) + written_.x0, 0, static_cast<std::size_t>(written_.width()));

    owned_hints_.clear();
    hints_.clear();
    moves_.clear();
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      const auto then = track_of(frame_hands_[h].side).pose_at(camera_ns);
      if (!then) continue;
      auto hint = make_hint(calibration_, settings_.mask, *then, tracked_[h]);
      if (!hint) continue;
      moves_.push_back(since_exposure(*then, tracked_[h]));
      owned_hints_.push_back(std::move(*hint));
    }
    for (const OwnedHint& owned : owned_hints_) {
      hints_.push_back(owned.hint);
      hints_.back().inside_px = owned.seeds_px;
    }
    written_ = mask_finder_.find(camera, hints_, camera_mask_.view());
    return advance_mask();
  }

  void learn_widths(std::int64_t target_ns) {
    if (!settings_.skin.fit || !settings_.skin.widths) return;
    for (const FrameHand& hand : frame_hands_)
      if (hand.has_landmarks) surface_of(hand).learn_widths(target_ns, to_projector(hand.corrected), projector_mask_.view());
  }

  /// How the hand has moved in the image, undone: from where it will be at the target time to where it was at the exposure.
  Similarity since_exposure(const msg::HandPose& then, const HandTrack::Tracked& now) const {
    const auto tracker_then = project_landmarks(calibration_, then);
    if (!settings_.mask.advance || !tracker_then) return {};
    return fit_similarity(now.tracker, *tracker_then);
  }

  /// The camera's mask in the projector's pixels, each hand moved on to where it will be. Where the bounds of two hands overlap, both
  /// move as the second does. Returns the part that has any mask.
  Rect advance_mask() {
    constexpr int kMargin_px = 2;
    Rect all;
    std::vector<Rect> regions;
    for (std::size_t h = 0; h < hints_.size(); ++h) {
      const Rect hand = mask_finder_.hand_bounds(h);
      const Rect moved = hand.empty() ? Rect{} : moved_back(hand, moves_[h]).grown(kMargin_px);
      regions.push_back(on_screen(lookup_.to_projector(moved)));
      all = all.joined(regions.back());
    }
    if (regions.size() > 1)
      for (int y = all.y0; y < all.y1; ++y) std::memset(projector_mask_.row(y) + all.x0, 0, static_cast<std::size_t>(all.width()));
    for (std::size_t h = 0; h < regions.size(); ++h) lookup_.resample(camera_mask_.view(), regions[h], projector_mask_.view(), moves_[h]);
    return all;
  }

  FillCounts paint(const Rect& region, bool masked) {
    if (region.empty()) return {};
    drawn_.clear();
    Rect source;
    for (const FrameHand& hand : frame_hands_) {
      const HandSurface& surface = surface_of(hand);
      drawn_.push_back(surface.drawn(grid_ ? surface.seen_px() : surface.landings_px()));
      source = source.joined(surface.bounds(surface.seen_px()));
    }
    source = on_screen(source);
    const bool warped = grid_ && !source.empty();
    painter_->draw(drawn_, warped ? source : region);
    stages_.mark(Stage::draw);
    if (warped) {
      painter_->warp(*grid_, source, region);
      stages_.mark(Stage::warp);
    }
    if (!masked) return {};
    const FillCounts counts = painter_->fill(projector_mask_.view(), settings_.fill, region);
    stages_.mark(Stage::fill);
    return counts;
  }

  config::Cascade settings_;
  float shading_;
  calib::Calibration calibration_;
  std::array<HandTrack, 2> tracks_;      ///< by side
  std::array<HandSurface, 2> surfaces_;  ///< by side
  MaskFinder mask_finder_;
  CameraLookup lookup_;
  Image<std::uint8_t> camera_mask_, projector_mask_;
  Rect written_;  ///< of the camera mask; the rest is 0
  std::unique_ptr<Painter> painter_;
  StageClock stages_;

  // One frame's.
  std::vector<HandTrack::Tracked> tracked_;  ///< beside frame_hands_
  std::vector<FrameHand> frame_hands_;
  std::vector<OwnedHint> owned_hints_;
  std::vector<HandHint> hints_;
  std::vector<Similarity> moves_;  ///< beside hints_: camera px at the target time to camera px at the exposure
  std::vector<DrawnHand> drawn_;
  std::optional<WarpGrid> grid_;
};

}  // namespace

Result<std::unique_ptr<Pipeline>> Pipeline::create(const config::Cascade& cascade, const config::Content& content, const config::Hand& hand,
                                                   const calib::Calibration& calibration, const Oracle& oracle) {
  if (cascade.filter.method == "ideal" && !oracle)
    return fail(Errc::bad_config, "cascade.filter.method = \"ideal\" needs the truth, which only `handcast simulate` knows");
  auto left = HandSurface::load(Side::left, hand.left, content.left, cascade.mask.forearm_mm);
  if (!left) return fail_in("left hand", left.error());
  auto right = HandSurface::load(Side::right, hand.right, content.right, cascade.mask.forearm_mm);
  if (!right) return fail_in("right hand", right.error());
  return std::make_unique<Cascade>(cascade, content, calibration, std::move(*left), std::move(*right), oracle);
}

}  // namespace handcast::renderer
