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

/// The whole cascade: sensor messages in, one image for the projector out. Its only inputs are
/// sensor messages and the times of the calls: the same inputs give bit-identical light. Called by
/// the projector daemon and by the simulator. One thread.
class Pipeline {
 public:
  /// The true landmarks of a hand at a time, undistorted camera px; empty if there are none. For
  /// the filter "ideal", in a simulator.
  using Oracle = std::function<std::optional<LandmarkPoints>(Side side, std::int64_t time_ns)>;

  /// Loads both hands and their contents. `painter`: draws the frames; it is for images of the
  /// projector's size. If it stops (Painter::failure()), and without one, cpu draws. Errors
  /// (bad_config): a hand file or a content cannot be loaded; the filter is "ideal" and there is no
  /// oracle.
  static Result<std::unique_ptr<Pipeline>> create(const config::Cascade& cascade,
                                                  const config::Content& content,
                                                  const config::Hand& hand,
                                                  const calib::Calibration& calibration,
                                                  const Oracle& oracle = {},
                                                  std::unique_ptr<Painter> painter = nullptr);

  /// Takes a message that arrived at `now_ns`. A message with an origin more than 50 ms later than
  /// that is dropped: all messages until its origin would count as older. So is a pose that is not
  /// plausible (is_plausible()).
  /// @{
  void push(std::int64_t now_ns, const msg::HandPoses& reported);
  void push(std::int64_t now_ns, const msg::Landmarks& reported);
  /// @}

  /// The first half of render(): the hands and their landmarks at `target_ns`, without drawing.
  /// Call it for frames that are not drawn, because filters remember their output of every frame.
  /// Landings are empty. Valid until the next call of track() or render().
  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns);

  /// Takes the image of a frame that is not drawn, because late registration follows the hands
  /// through all images and the person's widths are learned from them. Call it before track() of
  /// that frame; render() takes its own image. Not needed if looks() is false. Ignores an image
  /// that is not new, or is more than 50 ms later than the `now_ns` of the last frame.
  void look(const TimedImage& camera);
  /// True if look() has an effect.
  bool looks() const { return late_.on(); }

  /// Draws the frame whose photons arrive at `target_ns`. `camera`: the newest image, or none; an
  /// image more than 50 ms later than `now_ns` is ignored. Without hands the frame is dark and its
  /// region empty.
  Frame render(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera);

  /// Whether frames have Frame::uv and Frame::surface, for an observer. Off at first: a GPU needs
  /// time to read them back.
  void show_surface(bool on) { shows_surface_ = on; }

  /// Adds Frame::colour to a frame of the last render() that has only Frame::device, because its
  /// painter draws for the share group of an output, and the surface if it is shown. Call it after
  /// the light.
  void read_back(Frame& frame);

 private:
  /// One hand of the frame and the results of the steps so far.
  struct HandInFrame {
    HandPipeline* hand;
    HandFrame frame;
  };
  /// The target time of a frame and the exposure of its image.
  struct ImageUse {
    std::int64_t target_ns, origin_ns;
  };

  Pipeline(const config::Cascade& settings, const config::Content& content,
           const calib::Calibration& calibration, HandPipeline left, HandPipeline right,
           std::unique_ptr<Painter> painter);

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
  void learn(std::int64_t image_ns, std::int64_t target_ns);
  void learn_outline(std::int64_t target_ns);
  std::uint32_t rungs() const;
  Rect on_screen(const Rect& region) const { return region.within(screen_.x1, screen_.y1); }
  Rect landing_bounds() const;
  FillCounts paint(const Rect& region, bool is_masked);
  void add_surface(Frame& frame);
  bool replace_failed_painter();
  std::span<const FrameHand> frame_hands();

  config::Cascade settings_;
  glm::dmat4 camera_from_tracker_;
  float shading_;
  Rect screen_;
  HandSides sides_;
  std::array<HandPipeline, 2> both_;  ///< left, right
  HandMask mask_;
  LateRegistration late_;
  std::unique_ptr<Painter> painter_;
  StageClock stages_;
  msg::MadeFrom newest_;  ///< the newest messages, and the image of the last frame
  bool shows_surface_ = false;
  std::int64_t now_ns_ = 0;             ///< of the last frame
  std::optional<ImageUse> last_image_;  ///< of the last drawn frame, if it had an image

  std::optional<std::int64_t> looked_ns_;  ///< exposure of the image of look(), until track()

  // Of one frame; members so that their memory is reused.
  std::vector<HandInFrame> hands_;            ///< the hands of the frame
  std::vector<HandMask::Expected> expected_;  ///< one per entry of hands_
  std::vector<LateRegistration::Hand> late_hands_;
  std::vector<DrawnHand> drawn_;
  std::optional<WarpGrid> grid_;
  std::vector<FrameHand> frame_hands_;
};

}  // namespace handcast::renderer
