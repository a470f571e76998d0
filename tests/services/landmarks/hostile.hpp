// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <memory>

#include "ipc/msg/owned.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "tests/services/landmarks/pictures.hpp"

/// The twin's images, what its tracker says of them, and what can be done to them.
namespace handcast::test {

/// One camera image and what is known of it, in px: the reference rig's lens does not distort.
struct Sight {
  Grey image;
  landmarks::Hints tracker_px, truth_px;
  double seconds = 0;
};

class Sights {
 public:
  explicit Sights(const config::Twin& settings) {
    config::Rig rig;
    rig.twin = settings;
    auto opened = twin::Twin::create(rig, calib::reference_rig());
    EXPECT_TRUE(opened) << opened.error().what;
    twin_ = std::move(*opened);
  }

  /// With what the tracker would have said by then.
  Sight at(double seconds) const {
    const auto camera = calib::reference_rig().camera;
    const auto frame = number(seconds, twin_->camera_origin_ns(1000));
    const std::int64_t origin_ns = twin_->camera_origin_ns(frame);
    Sight sight{Grey(camera.width_px, camera.height_px), {}, {}, seconds};
    twin_->camera_image(frame, sight.image.view());
    landmarks::TrackerHints tracker(first_camera(calib::reference_rig()));
    for (auto k = number(seconds - 0.05, twin_->tracker_time_ns(1000));
         twin_->tracker_sample(k).arrival_ns <= origin_ns; ++k)
      tracker.push(twin_->tracker_sample(k).poses);
    sight.tracker_px = tracker.at(origin_ns);
    sight.truth_px = {twin_->landmarks(msg::Side::left, origin_ns),
                      twin_->landmarks(msg::Side::right, origin_ns)};
    return sight;
  }

 private:
  static std::uint64_t number(double seconds, std::int64_t thousandth_ns) {
    return static_cast<std::uint64_t>(std::max(seconds, 0.0) / ns_to_seconds(thousandth_ns) * 1000);
  }
  std::unique_ptr<twin::Twin> twin_;
};

/// What a detector says of an image taken at `time_ns`.
inline msg::Landmarks detect(landmarks::Detector& detector, const Sight& sight,
                             std::int64_t time_ns) {
  const auto width = static_cast<std::uint32_t>(sight.image.width()),
             height = static_cast<std::uint32_t>(sight.image.height());
  msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(width, height));
  frame->header = {1, time_ns, time_ns};
  frame->width_px = width;
  frame->height_px = height;
  std::ranges::copy(sight.image.pixels(), frame->pixels());
  const auto found =
      detector.detect(*frame, sight.tracker_px, Deadline::in(std::chrono::seconds(5)));
  EXPECT_TRUE(found) << found.error().what;
  return found.value_or(msg::Landmarks{});
}

/// The mean along a line of `length_px` to the right or downwards: a hand that moves while the
/// shutter is open.
inline Grey smeared(const Grey& image, int length_px, bool down) {
  return blurred(image, down ? 0 : length_px / 2, down ? length_px / 2 : 0);
}

/// Axes of a hand in the image, in palm lengths from the middle knuckle: towards the fingers, and
/// to the right of that.
struct PalmAxes {
  glm::vec2 knuckle, along, across;
  explicit PalmAxes(const landmarks::Points& hand_px) : knuckle(hand_px[9]) {
    const glm::vec2 palm = hand_px[9] - hand_px[0];
    along = palm / glm::dot(palm, palm);
    across = {-along.y, along.x};
  }
  glm::vec2 operator()(int x, int y) const {
    const glm::vec2 from = glm::vec2(x, y) - knuckle;
    return {glm::dot(from, along), glm::dot(from, across)};
  }
};

/// Skin from the wrist to the finger tips reflects another share of the light: `share(place)`.
template <class Share>
Grey gloved(const Grey& image, const landmarks::Points& hand_px, Share share) {
  constexpr int kSkin = 25;
  const PalmAxes axes(hand_px);
  return painted(image.width(), image.height(), [&](int x, int y) {
    const glm::vec2 place = axes(x, y);
    const double grey = image.at(x, y);
    const bool is_glove =
        grey >= kSkin && place.x > -1 && place.x < 1.5f && std::abs(place.y) < 1.4f;
    return is_glove ? 0.5 + grey * share(place) : grey;
  });
}

/// Something dark before all that lies beyond a line: `beyond` palm lengths from the middle knuckle
/// in direction `way` of its axes.
inline Grey half_covered(const Grey& image, const landmarks::Points& hand_px, glm::vec2 way,
                         float beyond) {
  const PalmAxes axes(hand_px);
  return painted(image.width(), image.height(), [&](int x, int y) {
    return glm::dot(axes(x, y), way) > beyond ? 4 : static_cast<int>(image.at(x, y));
  });
}

/// The camera turned away, so that the image and all in it moves by `by_px`.
inline Sight shifted(const Sight& sight, glm::ivec2 by_px) {
  Sight moved = sight;
  moved.image = painted(sight.image.width(), sight.image.height(), [&](int x, int y) {
    const glm::ivec2 from = glm::ivec2(x, y) - by_px;
    const bool is_seen =
        from.x >= 0 && from.y >= 0 && from.x < sight.image.width() && from.y < sight.image.height();
    return is_seen ? static_cast<int>(sight.image.at(from.x, from.y)) : 9;
  });
  for (auto* hints : {&moved.tracker_px, &moved.truth_px})
    for (auto& hand : *hints)
      for (int i = 0; hand && i < msg::kLandmarks; ++i) (*hand)[i] += glm::vec2(by_px);
  return moved;
}

}  // namespace handcast::test
