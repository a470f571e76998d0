#include "renderer/pipeline.hpp"

#include <algorithm>
#include <optional>

#include "renderer/pipeline/hand_light.hpp"
#include "renderer/pipeline/hand_mask.hpp"
#include "renderer/pipeline/hand_sides.hpp"
#include "renderer/pipeline/late_registration.hpp"
#include "renderer/pipeline/stage_clock.hpp"

namespace handcast::renderer {
namespace {

using msg::Stage;

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
        screen_{0, 0, calibration.projector_width_px, calibration.projector_height_px},
        both_{HandLight(Side::left, settings, calibration, std::move(left), of_side(oracle, Side::left)),
              HandLight(Side::right, settings, calibration, std::move(right), of_side(oracle, Side::right))},
        mask_(settings.mask, calibration),
        late_(registration_of(settings), settings.filter, calibration),
        painter_(make_cpu_painter(calibration.projector_width_px, calibration.projector_height_px)) {}

  void push(std::int64_t now_ns, const msg::HandPoses& reported) override {
    const std::int64_t origin_ns = reported.header.origin_ns;
    if (is_early(now_ns, origin_ns)) return;
    const auto poses = sides_.named(reported, {both_[0].track().recent_pose(origin_ns), both_[1].track().recent_pose(origin_ns)});
    for (HandLight& hand : both_)
      if (const msg::HandPose* pose = poses.find(hand.side())) hand.push(now_ns, origin_ns, *pose);
  }

  void push(std::int64_t now_ns, const msg::Landmarks& reported) override {
    const std::int64_t origin_ns = reported.header.origin_ns;
    if (is_early(now_ns, origin_ns)) return;
    const auto landmarks = sides_.named(reported, {both_[0].track().landmarks_at(origin_ns), both_[1].track().landmarks_at(origin_ns)});
    for (HandLight& hand : both_)
      if (const msg::HandLandmarks* seen = landmarks.find(hand.side())) hand.push(now_ns, origin_ns, *seen);
  }

  bool looks() const override { return late_.on(); }

  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns) override {
    predict(now_ns, target_ns);
    if (image_age_ns_) dim(target_ns);
    correct_motion(target_ns);
    return frame_hands();
  }

  void look(GreyView camera, std::int64_t camera_ns) override {
    if (!late_.on() || camera.data == nullptr || !late_.is_new(camera_ns) || is_early(now_ns_, camera_ns)) return;
    find_masks(camera, camera_ns);
    register_late(camera, camera_ns);
  }

  Frame render(std::int64_t now_ns, std::int64_t target_ns, GreyView camera, std::int64_t camera_ns) override {
    stages_.start();
    const bool masked = settings_.fill.method != "none" && camera.data != nullptr && !is_early(now_ns, camera_ns);
    image_age_ns_ = masked ? std::optional(target_ns - camera_ns) : std::nullopt;
    predict(now_ns, target_ns);
    stages_.mark(Stage::predict);

    if (masked) {
      find_masks(camera, camera_ns);
      dim(target_ns);
      stages_.mark(Stage::mask);
      register_late(camera, camera_ns);
    }
    correct_motion(target_ns);
    if (late_.on()) stages_.mark(Stage::registration);
    Rect region;
    if (masked) {
      region = advance_masks(camera_ns);
      stages_.mark(Stage::advance);
    }
    for (HandLight* hand : hands_) hand->skin(shading_);
    stages_.mark(Stage::skin);
    const int foldovers = correct();
    stages_.mark(Stage::correct, rungs());
    if (masked) learn_widths(target_ns);
    if (!masked) region = landing_bounds();

    const FillCounts counts = paint(region, masked);
    stages_.finish();
    return {target_ns, region.empty() ? Rect{} : region, painter_->colour(), frame_hands(), foldovers, counts, stages_.marks()};
  }

 private:
  /// From after it was heard of: believed, it would outdate all that comes until that time.
  static bool is_early(std::int64_t now_ns, std::int64_t origin_ns) {
    constexpr std::int64_t kMost_ns = 50'000'000;  // clocks are mapped to the host's, and not exactly
    return origin_ns > now_ns + kMost_ns;
  }

  Rect on_screen(const Rect& region) const { return region.within(screen_.x1, screen_.y1); }

  void predict(std::int64_t now_ns, std::int64_t target_ns) {
    now_ns_ = now_ns;
    // The image that the frame shows is as old as the last one's was; none where none is registered to.
    const auto camera_ns = image_age_ns_ && late_.on() ? std::optional(target_ns - *image_age_ns_) : std::nullopt;
    hands_.clear();
    for (HandLight& hand : both_)
      if (hand.predict(now_ns, target_ns, camera_ns)) hands_.push_back(&hand);
  }

  void expect(std::int64_t camera_ns) {
    expected_.clear();
    for (const HandLight* hand : hands_) expected_.push_back(hand->expected(camera_ns));
  }

  void find_masks(GreyView camera, std::int64_t camera_ns) {
    expect(camera_ns);
    mask_.find(camera, expected_);
    for (std::size_t h = 0; h < hands_.size(); ++h) hands_[h]->seen(mask_.shows(h));
  }

  void dim(std::int64_t target_ns) {
    for (HandLight* hand : hands_) hand->dim(target_ns);
  }

  /// Takes in a new image, whose mask was found.
  void register_late(GreyView camera, std::int64_t camera_ns) {
    if (!late_.on()) return;
    late_hands_.clear();
    for (const HandLight* hand : hands_)
      if (const auto late = hand->to_register()) late_hands_.push_back(*late);
    late_.look(mask_.silhouette(camera), camera_ns, late_hands_);
  }

  void correct_motion(std::int64_t target_ns) {
    if (!late_.on()) return;
    for (HandLight* hand : hands_) hand->correct_motion(late_, target_ns);
  }

  Rect advance_masks(std::int64_t camera_ns) {
    expect(camera_ns);
    return mask_.advance(expected_);
  }

  /// Moves the landings (and makes the grid, where the drawing is to be warped). Returns what was turned over.
  int correct() {
    grid_.reset();
    if (settings_.correct.method == "grid") return correct_by_grid();
    int foldovers = 0;
    if (settings_.correct.method == "vertices")
      for (HandLight* hand : hands_) foldovers += hand->correct();
    return foldovers;
  }

  /// One grid for all hands; a hand without landmarks holds its place in it.
  int correct_by_grid() {
    if (std::ranges::none_of(hands_, &HandLight::has_landmarks)) return 0;
    std::vector<glm::vec2> p, q;
    for (const HandLight* hand : hands_) {
      const LandmarkPoints from = hand->from_px(), to = hand->to_px();
      p.insert(p.end(), from.begin(), from.end());
      q.insert(q.end(), to.begin(), to.end());
    }
    grid_ = make_warp_grid(settings_.correct, screen_, MovingLeastSquares(p, q, static_cast<float>(settings_.correct.alpha)));
    for (HandLight* hand : hands_)
      for (glm::vec2& landing : hand->surface().landings_px()) landing = (*grid_)(landing);
    return grid_->foldovers();
  }

  std::uint32_t rungs() const {
    std::uint32_t detail = 0;
    for (const HandLight* hand : hands_) detail = msg::with_rung(detail, hand->side(), hand->rung());
    return detail;
  }

  void learn_widths(std::int64_t target_ns) {
    for (std::size_t h = 0; h < hands_.size(); ++h)
      if (mask_.shows(h)) hands_[h]->learn_widths(target_ns, mask_.in_projector());
  }

  Rect landing_bounds() const {
    Rect bounds;
    for (const HandLight* hand : hands_) bounds = bounds.joined(hand->surface().bounds(hand->surface().landings_px()));
    return on_screen(bounds);
  }

  FillCounts paint(const Rect& region, bool masked) {
    if (region.empty()) return {};
    drawn_.clear();
    Rect source;
    for (const HandLight* hand : hands_) {
      if (!hand->is_lit()) continue;
      const HandSurface& surface = hand->surface();
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

  std::span<const FrameHand> frame_hands() {
    frame_hands_.clear();
    for (const HandLight* hand : hands_) frame_hands_.push_back(hand->frame());
    return frame_hands_;
  }

  config::Cascade settings_;
  float shading_;
  Rect screen_;
  HandSides sides_;
  std::array<HandLight, 2> both_;  ///< left, right
  HandMask mask_;
  LateRegistration late_;
  std::unique_ptr<Painter> painter_;
  StageClock stages_;
  std::int64_t now_ns_ = 0;                   ///< of the last frame
  std::optional<std::int64_t> image_age_ns_;  ///< of the last frame's image at the time of its light

  // One frame's.
  std::vector<HandLight*> hands_;             ///< those in sight
  std::vector<HandMask::Expected> expected_;  ///< beside them
  std::vector<LateRegistration::Hand> late_hands_;
  std::vector<DrawnHand> drawn_;
  std::optional<WarpGrid> grid_;
  std::vector<FrameHand> frame_hands_;
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
