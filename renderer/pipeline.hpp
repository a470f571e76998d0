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
#include "ipc/msg/rung.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "renderer/painter.hpp"

namespace handcast::renderer {

/// One hand of a finished frame, for scores and traces.
struct FrameHand {
  Side side = Side::left;
  LandmarkPoints tracker{};             ///< P at the target time, undistorted camera px
  LandmarkPoints corrected{};           ///< Q̂ (P where nothing corrects)
  bool has_landmarks = false;           ///< corrected follows what the filter knows, be it that P is best left alone
  std::span<const glm::vec2> landings;  ///< per vertex: where its light lands, projector px
  msg::Rung rung = msg::Rung::landmarks;
};

/// One finished frame. Everything it points to is valid until the next render().
struct Frame {
  std::int64_t target_ns = 0;
  Rect region;                       ///< all light is inside
  View<const std::uint32_t> colour;  ///< the projector's size; defined inside `region`; alpha 0: dark
  std::span<const FrameHand> hands;
  int foldovers = 0;
  FillCounts fill;
  std::span<const msg::StageMark> stages;  ///< of this frame, on the host's clock
};

/// The cascade, whole: sensor messages in, one image for the projector out. It sees sensors only: the same messages at the
/// same times give bit-identical light. The projector daemon and the simulator both call it. One thread.
class Pipeline {
 public:
  /// Where the landmarks of a hand truly are (undistorted camera px): for the filter "ideal", in a simulator.
  using Oracle = std::function<std::optional<LandmarkPoints>(Side side, std::int64_t time_ns)>;

  /// Errors: bad_config (hand file, content, "ideal" without an oracle).
  static Result<std::unique_ptr<Pipeline>> create(const config::Cascade& cascade, const config::Content& content, const config::Hand& hand,
                                                  const calib::Calibration& calibration, const Oracle& oracle = {});
  virtual ~Pipeline() = default;

  /// A message arrived at `now_ns`. One whose origin is more than 50 ms after that is not taken: it would outdate all that come until
  /// then.
  virtual void push(std::int64_t now_ns, const msg::HandPoses& poses) = 0;
  virtual void push(std::int64_t now_ns, const msg::Landmarks& landmarks) = 0;

  /// The first half of render(): where the hands and their landmarks will be at `target_ns`, without drawing. A caller that skips
  /// frames calls it for those, so that filters with a memory of their output see every frame. Landings are empty.
  virtual std::span<const FrameHand> track(std::int64_t now_ns, std::int64_t target_ns) = 0;

  /// A new image, exposed around `camera_ns`, of a frame that is not drawn: what moves between the images is followed in all of them.
  /// Before that frame's track(). render() looks at its own. Not needed where looks() is false: nothing would come of it.
  /// An image from more than 50 ms after the frame before is not looked at.
  virtual void look(GreyView /*camera*/, std::int64_t /*camera_ns*/) {}
  virtual bool looks() const { return false; }

  /// Draws the frame whose light will be seen at `target_ns`. `camera` is the newest image (image px; data may be null: no camera yet),
  /// exposed around `camera_ns`; one from more than 50 ms after `now_ns` is none. No hand in sight gives a dark frame with an empty region.
  virtual Frame render(std::int64_t now_ns, std::int64_t target_ns, GreyView camera, std::int64_t camera_ns) = 0;
};

}  // namespace handcast::renderer
