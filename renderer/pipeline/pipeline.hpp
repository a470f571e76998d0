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
#include "config/sections/content.hpp"
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

/// What a frame is drawn from. Borrowed for FramePainter::draw().
struct FrameDrawing {
  std::span<const DrawnHand> hands;
  Rect region;                     ///< contains all light
  Rect source;                     ///< contains the hands, if they are to be warped
  const WarpGrid* grid = nullptr;  ///< warps the hands from `source` to `region`
  GreyView mask;                   ///< of the hands, projector px; null: there is none
};

/// Steps draw and fill: makes the image of a frame. One thread.
class FramePainter {
 public:
  /// `painter`: draws the frames until it fails (Painter::failure()); after that, and without one,
  /// cpu does.
  FramePainter(std::unique_ptr<Painter> painter, const config::Fill& settings, int width_px,
               int height_px);

  /// Fills by other settings from now on.
  void adjust(const config::Fill& settings) { settings_ = settings; }
  /// Keeps these rectangles dark from now on, projector px.
  void keep_dark(std::vector<Rect> areas) { dark_ = std::move(areas); }

  /// Sets colour, device, fill and, if it is shown, the surface of `frame`. Marks the stages.
  void draw(const FrameDrawing& drawing, StageClock& stages, Frame& frame);

  /// See Pipeline::show_surface() and Pipeline::read_back().
  /// @{
  void show_surface(bool on) { shows_surface_ = on; }
  void read_back(Frame& frame);
  /// @}

 private:
  FillCounts paint(const FrameDrawing& drawing, StageClock& stages);
  void add_surface(Frame& frame);
  bool replace_failed();

  std::unique_ptr<Painter> painter_;
  config::Fill settings_;
  int width_px_, height_px_;
  bool shows_surface_ = false;
  std::vector<Rect> dark_;  ///< projector px
};

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
  /// oracle. If the calibration has a second projector, the light is shared with it.
  static Result<std::unique_ptr<Pipeline>> create(const config::Cascade& cascade,
                                                  const config::Content& content,
                                                  const config::Hand& hand,
                                                  const calib::Calibration& calibration,
                                                  const Oracle& oracle = {},
                                                  std::unique_ptr<Painter> painter = nullptr);

  /// Uses other settings from the next frame on: all live ones of the cascade, whose filter must
  /// not be "ideal", and content.shading. What was learned stays; a filter whose settings change
  /// begins with the next detection.
  void adjust(const config::Cascade& cascade, const config::Content& content);

  /// Draws into other pixels from the next frame on: `pixels` maps those of the calibration to them
  /// (a mirror, a shift). What was learned stays.
  void aim(const glm::dmat3& pixels);

  /// Takes a message that arrived at `now_ns`. A message with an origin more than 50 ms later than
  /// that is dropped: all messages until its origin would count as older. So is a pose that is not
  /// plausible (is_plausible()).
  /// @{
  void push(std::int64_t now_ns, const msg::HandPoses& reported);
  void push(std::int64_t now_ns, const msg::Landmarks& reported);
  /// @}

  /// Paints this picture on a hand from now on, in place of that of the settings. Borrowed until
  /// the next call for this hand; without texels: that of the settings again.
  void wear(Side side, const MipView& picture) {
    both_[static_cast<std::size_t>(side)].wear(picture);
  }

  /// Keeps these rectangles dark from now on, whatever is drawn; projector px.
  void keep_dark(std::vector<Rect> areas) { painter_.keep_dark(std::move(areas)); }

  /// What is on of a second projector's light from now on, 0..1 (LightShare::apply()); 1 at first.
  void set_beside(float share) { beside_ = share; }

  /// Draws the frame whose photons arrive at `target_ns`. `camera`: the newest image, or none; an
  /// image more than 50 ms later than `now_ns` is ignored. Without hands the frame is dark and its
  /// region empty.
  Frame render(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera);

  /// The same without drawing: the hands and their landmarks. Call it for frames that are not
  /// drawn, because filters remember their output of every frame, late registration follows the
  /// hands through all images, and the person's hand is learned from them. An image that was given
  /// before is ignored. No vertices are projected, unless the frame learns from its image. Valid
  /// until the next call of track() or render().
  std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns,
                                   const TimedImage& camera = {});
  /// True if track() uses images.
  bool looks() const { return late_.on(); }

  /// Whether frames have Frame::uv and Frame::surface, for an observer. Off at first: a GPU needs
  /// time to read them back.
  void show_surface(bool on) { painter_.show_surface(on); }

  /// Adds Frame::colour to a frame of the last render() that has only Frame::device, because its
  /// painter draws for the share group of an output, and the surface if it is shown. Call it after
  /// the light.
  void read_back(Frame& frame) { painter_.read_back(frame); }

 private:
  /// One hand of the frame and the results of the steps so far.
  struct HandInFrame {
    HandPipeline* hand;
    HandFrame frame;
  };
  /// A frame before it is drawn.
  struct Placed {
    Rect region;             ///< contains all light
    bool is_masked = false;  ///< the masks were found in the frame's image
    int foldovers = 0;       ///< triangles that the correction turned over
  };
  /// What the steps pass on in one frame. A member so that its memory is reused.
  struct Passed {
    Passed();

    std::vector<HandInFrame> hands;
    std::vector<HandMask::Sought> sought;
    std::vector<HandMask::Moved> moved;
    std::vector<LateRegistration::Hand> late;
    WarpGrid grid;
    bool is_warped = false;                           ///< by the grid
    std::vector<glm::vec2> grid_from_px, grid_to_px;  ///< control points of the grid
    std::vector<DrawnHand> drawn;
    std::vector<FrameHand> described;
    std::vector<LightShare::Hand> shared;
  };

  Pipeline(const config::Cascade& settings, const config::Content& content,
           const calib::Calibration& calibration, HandPipeline left, HandPipeline right,
           std::unique_ptr<Painter> painter);

  Placed place(std::int64_t now_ns, std::int64_t target_ns, const TimedImage& camera,
               bool is_drawn);
  void predict(std::int64_t now_ns, std::int64_t target_ns);
  void see(const TimedImage& camera);
  int correct(config::CorrectMethod method);
  int correct_by_grid();
  Rect advance_masks();
  void learn_outline(std::int64_t target_ns);
  void share_light();
  FrameDrawing drawing_of(const Placed& placed);
  std::uint32_t rungs() const;
  Rect on_screen(const Rect& region) const { return region.within(screen_.x1, screen_.y1); }
  Rect projected_bounds() const;
  std::span<const FrameHand> frame_hands();

  config::Cascade settings_;
  calib::ProjectorModel projector_;  ///< of the calibration
  float shading_;
  Rect screen_;
  HandSides sides_;
  std::array<HandPipeline, 2> both_;  ///< left, right
  bool is_aside_;                     ///< the mask in the camera's image is none for the projector
  HandMask mask_;
  LateRegistration late_;
  std::optional<LightShare> share_;  ///< empty if there is one projector
  float beside_ = 1;
  FramePainter painter_;
  StageClock stages_;
  msg::MadeFrom newest_;   ///< the newest messages, and the image of the last frame
  bool was_seen_ = false;  ///< the hands were searched in the image of the last drawn frame
  Passed passed_;
};

}  // namespace handcast::renderer
