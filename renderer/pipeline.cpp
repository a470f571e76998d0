#include "renderer/pipeline.hpp"

#include <algorithm>
#include <optional>

#include "renderer/pipeline/hand_ladder.hpp"
#include "renderer/pipeline/hand_mask.hpp"
#include "renderer/pipeline/hand_sides.hpp"
#include "renderer/pipeline/hand_surface.hpp"
#include "renderer/pipeline/hand_track.hpp"
#include "renderer/pipeline/late_registration.hpp"
#include "renderer/pipeline/stage_clock.hpp"

namespace handcast::renderer {
namespace {

using msg::Stage;

LandmarkOracle of_side(const Pipeline::Oracle& oracle, Side side) {
  if (!oracle) return {};
  return [oracle, side](std::int64_t time_ns) { return oracle(side, time_ns); };
}

/// None where a lower rung is set, or where the landmarks do not move with the tracker, whose prediction registration corrects.
config::Registration registration_of(const config::Cascade& settings) {
  config::Registration registration = settings.registration;
  if (!moves_with_tracker(settings.filter)) registration.method = "none";
  if (settings.ladder.rung != "auto" && settings.ladder.rung != "register") registration.method = "none";
  return registration;
}

/// With late registration jumps are blended in after it.
config::Cascade of_tracks(config::Cascade settings) {
  if (registration_of(settings).method != "none") settings.filter.blend_ms = 0;
  return settings;
}

class Cascade final : public Pipeline {
 public:
  Cascade(const config::Cascade& settings, const config::Content& content, const calib::Calibration& calibration, HandSurface left,
          HandSurface right, const Oracle& oracle)
      : settings_(settings),
        shading_(static_cast<float>(content.shading)),
        calibration_(calibration),
        tracks_{HandTrack(of_tracks(settings), calibration, of_side(oracle, Side::left)),
                HandTrack(of_tracks(settings), calibration, of_side(oracle, Side::right))},
        ladders_{HandLadder(settings, calibration), HandLadder(settings, calibration)},
        surfaces_{std::move(left), std::move(right)},
        movers_{RungMover(surfaces_[0].mesh()), RungMover(surfaces_[1].mesh())},
        mask_(settings.mask, calibration),
        late_(registration_of(settings), settings.filter, calibration),
        painter_(make_cpu_painter(calibration.projector_width_px, calibration.projector_height_px)) {}

  void push(std::int64_t now_ns, const msg::HandPoses& reported) override {
    const std::int64_t origin_ns = reported.header.origin_ns;
    const auto poses = sides_.named(reported, {tracks_[0].recent_pose(origin_ns), tracks_[1].recent_pose(origin_ns)});
    for (const Side side : {Side::left, Side::right})
      if (const msg::HandPose* pose = poses.find(side)) {
        track_of(side).push(now_ns, origin_ns, *pose);
        surfaces_[static_cast<std::size_t>(side)].learn(origin_ns, *pose);
      }
  }

  void push(std::int64_t now_ns, const msg::Landmarks& reported) override {
    const std::int64_t origin_ns = reported.header.origin_ns;
    const auto landmarks = sides_.named(reported, {tracks_[0].landmarks_at(origin_ns), tracks_[1].landmarks_at(origin_ns)});
    for (const Side side : {Side::left, Side::right})
      if (const msg::HandLandmarks* seen = landmarks.find(side)) {
        if (!track_of(side).alone()) ladder_of(side).detection(track_of(side), origin_ns, *seen);
        track_of(side).push(now_ns, origin_ns, *seen);
      }
  }

  bool looks() const override { return late_.on(); }

  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns) override {
    predict(now_ns, target_ns);
    if (image_age_ns_) dim(target_ns);
    correct_motion(target_ns);
    return frame_hands_;
  }

  void look(GreyView camera, std::int64_t camera_ns) override {
    if (!late_.on() || camera.data == nullptr || !late_.is_new(camera_ns)) return;
    expect(camera_ns);
    find_masks(camera);
    register_late(camera, camera_ns);
  }

  Frame render(std::int64_t now_ns, std::int64_t target_ns, GreyView camera, std::int64_t camera_ns) override {
    stages_.start();
    const bool masked = settings_.fill.method != "none" && camera.data != nullptr;
    image_age_ns_ = masked ? std::optional(target_ns - camera_ns) : std::nullopt;
    predict(now_ns, target_ns);
    stages_.mark(Stage::predict);

    Rect region;
    if (masked) {
      expect(camera_ns);
      find_masks(camera);
      dim(target_ns);
      stages_.mark(Stage::mask);
      register_late(camera, camera_ns);
    }
    correct_motion(target_ns);
    if (late_.on()) stages_.mark(Stage::registration);
    if (masked) {
      region = mask_.advance(expected_);
      stages_.mark(Stage::advance);
    }
    skin_hands();
    stages_.mark(Stage::skin);
    const int foldovers = correct();
    stages_.mark(Stage::correct, rungs());
    if (masked) learn_widths(target_ns);
    if (!masked) region = landing_bounds();

    const FillCounts counts = paint(region, masked);
    stages_.finish();
    return {target_ns, region.empty() ? Rect{} : region, painter_->colour(), frame_hands_, foldovers, counts, stages_.marks()};
  }

 private:
  HandTrack& track_of(Side side) { return tracks_[static_cast<std::size_t>(side)]; }
  HandLadder& ladder_of(Side side) { return ladders_[static_cast<std::size_t>(side)]; }
  Sight& sight_of(Side side) { return sights_[static_cast<std::size_t>(side)]; }
  HandSurface& surface_of(const FrameHand& hand) { return surfaces_[static_cast<std::size_t>(hand.side)]; }
  Rect on_screen(const Rect& region) const { return region.within(calibration_.projector_width_px, calibration_.projector_height_px); }

  void predict(std::int64_t now_ns, std::int64_t target_ns) {
    frame_hands_.clear();
    tracked_.clear();
    steps_.clear();
    for (const Side side : {Side::left, Side::right}) {
      auto tracked = track_of(side).at(now_ns, target_ns);
      if (!tracked) {
        sight_of(side).gone(target_ns);
        continue;
      }
      if (tracked->alone) ladder_of(side) = HandLadder(settings_, calibration_);  // what it has learned was of another tracker
      steps_.push_back(tracked->alone ? HandLadder::Step{Rung::landmarks, Rung::landmarks, 0}
                                      : ladder_of(side).take(track_of(side), target_ns, image_of(target_ns), *tracked));
      tracked_.push_back(*tracked);
      frame_hands_.push_back({side, tracked->tracker, tracked->corrected, tracked->has_landmarks, {}, steps_.back().rung});
    }
  }

  void find_masks(GreyView camera) {
    mask_.find(camera, expected_);
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) in_sight_[static_cast<std::size_t>(frame_hands_[h].side)] = mask_.shows(h);
  }

  /// Takes the light from hands that the newest image does not show, little by little.
  void dim(std::int64_t target_ns) {
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      const Side side = frame_hands_[h].side;
      tracked_[h].presence = std::min(tracked_[h].presence, sight_of(side).at(target_ns, in_sight_[static_cast<std::size_t>(side)]));
    }
  }

  /// When the image was taken that a frame for `target_ns` shows, as old as the last one's was; nothing where none is registered to.
  std::optional<std::int64_t> image_of(std::int64_t target_ns) const {
    return image_age_ns_ && late_.on() ? std::optional(target_ns - *image_age_ns_) : std::nullopt;
  }

  void skin_hands() {
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      HandSurface& surface = surface_of(frame_hands_[h]);
      surface.pose(tracked_[h].pose, settings_.skin, calibration_, shading_, tracked_[h].presence);
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

  std::uint32_t rungs() const {
    std::uint32_t detail = 0;
    for (const FrameHand& hand : frame_hands_) detail = msg::with_rung(detail, hand.side, hand.rung);
    return detail;
  }

  LandmarkPoints to_projector(const LandmarkPoints& camera_px) const {
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i) points[i] = calibration_.to_projector(camera_px[i]);
    return points;
  }

  int correct_by_vertices() {
    int foldovers = 0;
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      const FrameHand& hand = frame_hands_[h];
      if (!hand.has_landmarks) continue;
      HandSurface& surface = surface_of(hand);
      const LandmarkPoints from = to_projector(hand.tracker), to = to_projector(hand.corrected);
      if (steps_[h].moves < Rung::landmarks) {
        movers_[static_cast<std::size_t>(hand.side)].move(fit_rung(steps_[h].moves, from, to), surface.landings_px());
      } else {
        correct_vertices(settings_.correct, surface.mesh(), from, to, surface.landings_px());
      }
      if (steps_[h].moves >= Rung::fingers) foldovers += surface.untangle();
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

  /// The hands as the mask is to look for them in an image exposed around `camera_ns`.
  void expect(std::int64_t camera_ns) {
    expected_.clear();
    for (std::size_t h = 0; h < frame_hands_.size(); ++h)
      expected_.push_back({frame_hands_[h].side, track_of(frame_hands_[h].side).pose_at(camera_ns), &tracked_[h]});
  }

  /// Takes in a new image, whose mask was found.
  void register_late(GreyView camera, std::int64_t camera_ns) {
    if (!late_.on()) return;
    late_hands_.clear();
    for (std::size_t h = 0; h < frame_hands_.size(); ++h)
      if (tracked_[h].has_landmarks && steps_[h].registered > 0) late_hands_.push_back(late_hand(h));
    late_.look(mask_.silhouette(camera), camera_ns, late_hands_);
  }

  LateRegistration::Hand late_hand(std::size_t h) {
    LateRegistration::Hand hand{frame_hands_[h].side, &track_of(frame_hands_[h].side), tracked_[h].tracker, {}};
    for (int i = 0; i < kLandmarks; ++i) hand.offset_px[i] = tracked_[h].corrected[i] - tracked_[h].tracker[i];
    return hand;
  }

  /// Moves the landmarks by what the newest images know of the motion and the tracker does not.
  void correct_motion(std::int64_t target_ns) {
    if (!late_.on()) return;
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      if (!tracked_[h].has_landmarks) continue;
      if (tracked_[h].alone) {
        frame_hands_[h].corrected = late_.follow(late_hand(h), target_ns, tracked_[h].news);
        continue;
      }
      const auto late = late_.correct(late_hand(h), target_ns, steps_[h].registered);
      frame_hands_[h].corrected = late.points;
      if (steps_[h].registered == 1) ladder_of(frame_hands_[h].side).registered(target_ns, late.moved_target);
      if (h >= expected_.size()) continue;
      expected_[h].moved_then = late.moved_then;
      expected_[h].moved_now = late.moved_target;
    }
  }

  void learn_widths(std::int64_t target_ns) {
    if (!settings_.skin.fit || !settings_.skin.widths) return;
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      const FrameHand& hand = frame_hands_[h];
      if (hand.has_landmarks && mask_.shows(h))
        surface_of(hand).learn_widths(target_ns, to_projector(hand.corrected), mask_.in_projector());
    }
  }

  FillCounts paint(const Rect& region, bool masked) {
    if (region.empty()) return {};
    drawn_.clear();
    Rect source;
    for (std::size_t h = 0; h < frame_hands_.size(); ++h) {
      if (tracked_[h].presence <= 0) continue;
      const HandSurface& surface = surface_of(frame_hands_[h]);
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
    const FillCounts counts = painter_->fill(mask_.in_projector(), settings_.fill, region);
    stages_.mark(Stage::fill);
    return counts;
  }

  config::Cascade settings_;
  float shading_;
  calib::Calibration calibration_;
  HandSides sides_;
  std::array<HandTrack, 2> tracks_;      ///< by side
  std::array<HandLadder, 2> ladders_;    ///< by side
  std::array<HandSurface, 2> surfaces_;  ///< by side
  std::array<RungMover, 2> movers_;      ///< by side
  std::array<Sight, 2> sights_;          ///< by side
  std::array<bool, 2> in_sight_{};       ///< by side: the newest image shows it
  HandMask mask_;
  LateRegistration late_;
  std::unique_ptr<Painter> painter_;
  StageClock stages_;
  std::optional<std::int64_t> image_age_ns_;  ///< of the last frame's image at the time of its light

  // One frame's.
  std::vector<HandTrack::Tracked> tracked_;  ///< beside frame_hands_
  std::vector<FrameHand> frame_hands_;
  std::vector<HandLadder::Step> steps_;       ///< likewise
  std::vector<HandMask::Expected> expected_;  ///< likewise
  std::vector<LateRegistration::Hand> late_hands_;
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
