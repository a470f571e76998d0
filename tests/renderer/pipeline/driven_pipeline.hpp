// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "renderer/pipeline/pipeline.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {

/// By default its pictures are not smooth, so that a pixel is either lit or dark.
inline std::unique_ptr<Pipeline> make_pipeline(
    const config::Cascade& settings = {}, const calib::Calibration& calibration = rig_above_hand(),
    const config::Content& content = {.smooth = false}) {
  auto pipeline = Pipeline::create(settings, content, {}, calibration);
  if (!pipeline) throw std::runtime_error(pipeline.error().what);
  return std::move(*pipeline);
}

inline config::Cascade cascade(config::CorrectMethod correct, config::FillMethod fill) {
  config::Cascade settings;
  settings.correct.method = correct;
  settings.fill.method = fill;
  return settings;
}

/// Adds tracker samples of still hands up to `until_ns`.
inline void feed_still(Pipeline& pipeline, const std::vector<msg::HandPose>& hands,
                       std::int64_t until_ns = 100 * kMs) {
  for (std::int64_t t = 0; t <= until_ns; t += 9 * kMs)
    pipeline.push(t + 9 * kMs, poses_of(t, hands));
}

/// Adds detections of `hand` with an error of `offset_px`, and calls track() between them.
inline void feed_landmarks(Pipeline& pipeline, const calib::Calibration& calibration,
                           const msg::HandPose& hand, glm::vec2 offset_px) {
  for (std::int64_t t = 20 * kMs; t <= 100 * kMs; t += 2 * kMs) {
    if (t % (16 * kMs) == 0)
      pipeline.push(t, landmarks_of(calibration, t - 16 * kMs, hand, offset_px));
    pipeline.track(t, t + 4 * kMs);
  }
}

inline bool lit(const Frame& frame, int x, int y) {
  const Rect& r = frame.region;
  return x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1 && frame.colour.at(x, y) >> 24 > 0;
}

/// The number of lit pixels in `part` of a frame.
inline int lit_pixels(const Frame& frame, const Rect& part = {0, 0, 1 << 20, 1 << 20}) {
  const Rect region = frame.region.overlap(part);
  int count = 0;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) count += lit(frame, x, y);
  return count;
}

/// Grey value of the camera image at a projector pixel, moved by `aside_px` camera px.
inline int grey_at(const calib::Calibration& calibration, const Image<std::uint8_t>& image, int x,
                   int y, glm::dvec2 aside_px = {}) {
  const glm::dvec2 at =
      calibration.camera.distort(calibration.projector.camera_pixel_of({x, y})) + aside_px;
  const int cx = static_cast<int>(std::lround(at.x)), cy = static_cast<int>(std::lround(at.y));
  return cx < 0 || cy < 0 || cx >= image.width() || cy >= image.height() ? 0 : image.at(cx, cy);
}

/// True if there is no hand within a tenth of a camera pixel, the accuracy of CameraLookup.
inline bool beside_hand(const calib::Calibration& calibration, const Image<std::uint8_t>& image,
                        int x, int y) {
  int most = 0;
  for (const glm::dvec2 aside :
       {glm::dvec2(0.1, 0), glm::dvec2(-0.1, 0), glm::dvec2(0, 0.1), glm::dvec2(0, -0.1)})
    most = std::max(most, grey_at(calibration, image, x, y, aside));
  return most < 100;
}

/// Numbers of projector pixels.
struct LightCount {
  int hand_px = 0;   ///< on the hand, above its wrist
  int dark_px = 0;   ///< of these, without light
  int spill_px = 0;  ///< with light, beside the hand
};
inline LightCount count_light(const Frame& frame, const calib::Calibration& calibration,
                              const Image<std::uint8_t>& image, double wrist_y_px) {
  LightCount count;
  for (int y = 0; y < 768; ++y)
    for (int x = 0; x < 1024; ++x) {
      const bool on_hand = y < wrist_y_px && grey_at(calibration, image, x, y) > 100;
      count.hand_px += on_hand;
      count.dark_px += on_hand && !lit(frame, x, y);
      count.spill_px += lit(frame, x, y) && beside_hand(calibration, image, x, y);
    }
  return count;
}

inline glm::vec2 mean_vertex(const FrameHand& hand) {
  glm::vec2 sum{0};
  for (const glm::vec2& vertex : hand.projected_px)
    sum += vertex / static_cast<float>(hand.projected_px.size());
  return sum;
}

}  // namespace handcast::renderer
