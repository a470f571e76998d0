// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "config/sections/projector.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/draw/painter.hpp"
#include "renderer/mask/hand_mask.hpp"
#include "renderer/pipeline/frame.hpp"
#include "renderer/pipeline/hand_pipeline.hpp"
#include "renderer/pipeline/stage_clock.hpp"
#include "renderer/predict/hand_sides.hpp"
#include "renderer/register/late_registration.hpp"

namespace handcast::renderer {

/// The cascade, whole: sensor messages in, one image for the projector out. It sees sensors only:
/// the same messages at the same times give bit-identical light. The projector daemon and the
/// simulator both call it. One thread.
class Pipeline {
 public:
  /// Where the landmarks of a hand truly are (undistorted camera px): for the filter "ideal", in a
  /// simulator.
  using Oracle = std::function<std::optional<LandmarkPoints>(Side side, std::int64_t time_ns)>;

  /// Errors: bad_config (hand file, content, "ideal" without an oracle).
  static Result<std::unique_ptr<Pipeline>> create(const config::Cascade& cascade,
                                                  const config::Content& content,
                                                  const config::Hand& hand,
                                                  const calib::Calibration& calibration,
                                                  const Oracle& oracle = {});

  /// A message arrived at `now_ns`. One whose origin is more than 50 ms after that is dropped: it
  /// would outdate all that come until then.
  void push(std::int64_t now_ns, const msg::HandPoses& reported);
  void push(std::int64_t now_ns, const msg::Landmarks& reported);

  /// The first half of render(): where the hands and their landmarks will be at `target_ns`,
  /// without drawing. A caller that skips frames calls it for those, so that filters with a memory
  /// of their output see every frame. Landings are empty.
  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns);

  /// A new image of a frame that is not drawn: what moves between the images is followed in all of
  /// them. Call it before that frame's track(); render() looks at its own image. Not needed if
  /// looks() is false. An image from more than 50 ms after the frame before is not looked at.
  void look(const TimedImage& camera);
  bool looks() const { return late_.on(); }

  /// Draws the frame whose light will be seen at `target_ns`. `camera`: the newest image (image
  /// px), or none; one from more than 50 ms after `now_ns` counts as none. No hand in sight gives a
  /// dark frame with an empty region.
  Frame render(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera);

 private:
  /// One hand in sight and what the frame has made of it so far.
  struct HandInFrame {
    HandPipeline* hand;
    HandFrame frame;
  };
  /// When the last drawn frame was for, and when its image was exposed.
  struct ImageUse {
    std::int64_t target_ns, origin_ns;
  };

  Pipeline(const config::Cascade& settings, const config::Content& content,
           const calib::Calibration& calibration, HandPipeline left, HandPipeline right);

  void predict(std::int64_t now_ns, std::int64_t target_ns, std::optional<std::int64_t> image_ns);
  std::optional<std::int64_t> expected_image_ns(std::int64_t target_ns) const;
  void expect(std::int64_t image_ns);
  void find_masks(const TimedImage& camera);
  void dim(std::int64_t target_ns);
  void register_late(const TimedImage& camera);
  void register_motion(std::int64_t target_ns);
  Rect advance_masks(const TimedImage& camera);
  int correct();
  int correct_by_grid();
  void learn_widths(std::int64_t target_ns);
  std::uint32_t rungs() const;
  Rect on_screen(const Rect& region) const { return region.within(screen_.x1, screen_.y1); }
  Rect landing_bounds() const;
  FillCounts paint(const Rect& region, bool is_masked);
  std::span<const FrameHand> frame_hands();

  config::Cascade settings_;
  float shading_;
  Rect screen_;
  HandSides sides_;
  std::array<HandPipeline, 2> both_;  ///< left, right
  HandMask mask_;
  LateRegistration late_;
  std::unique_ptr<Painter> painter_;
  StageClock stages_;
  msg::MadeFrom newest_;                ///< the newest inputs; of images the last frame's
  std::int64_t now_ns_ = 0;             ///< of the last frame
  std::optional<ImageUse> last_image_;  ///< of the last drawn frame, if it had an image

  // One frame's; members, so that their memory is kept.
  std::vector<HandInFrame> hands_;            ///< those in sight
  std::vector<HandMask::Expected> expected_;  ///< beside them
  std::vector<LateRegistration::Hand> late_hands_;
  std::vector<DrawnHand> drawn_;
  std::optional<WarpGrid> grid_;
  std::vector<FrameHand> frame_hands_;
};

}  // namespace handcast::renderer
