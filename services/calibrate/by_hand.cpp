// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/by_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "calib/screen/plane_consensus.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr double kInset = 0.1;
constexpr std::array<std::string_view, 4> kNames{"top left", "top right", "bottom right",
                                                 "bottom left"};
constexpr double kLeastStep_px = 0.5, kMostStep_px = 50;

/// The camera's image as the homography puts it, with a cross at a projector pixel. Brightened,
/// because infrared images are dark.
void draw(const msg::CameraFrame& frame, const calib::CameraModel& camera,
          const glm::dmat3& camera_from_projector, const glm::dvec2& cross_px, int width_px,
          int height_px, std::uint8_t* levels) {
  constexpr int kGain = 3, kArm_px = 20;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      const auto at = camera_from_projector * glm::dvec3(x, y, 1);
      const auto px = glm::ivec2(glm::round(camera.distort(glm::dvec2(at) / at.z)));
      const bool inside = px.x >= 0 && px.y >= 0 && px.x < static_cast<int>(frame.width_px) &&
                          px.y < static_cast<int>(frame.height_px);
      const int grey = inside ? frame.pixels()[px.y * static_cast<int>(frame.width_px) + px.x] : 0;
      const double dx = std::abs(x - cross_px.x), dy = std::abs(y - cross_px.y);
      const bool is_cross = (dx < 1.5 && dy < kArm_px) || (dy < 1.5 && dx < kArm_px);
      *levels++ = static_cast<std::uint8_t>(is_cross ? 255 : std::min(255, kGain * grey));
    }
}

}  // namespace

DraggedCorners::DraggedCorners(const calib::Calibration& draft) {
  const double w = draft.camera.width_px - 1, h = draft.camera.height_px - 1;
  const double near = kInset, far = 1 - kInset;
  camera_px_ = {
      {{near * w, near * h}, {far * w, near * h}, {far * w, far * h}, {near * w, far * h}}};
  for (std::size_t i = 0; i < 4; ++i) projector_px_[i] = draft.to_projector(camera_px_[i]);
}

bool DraggedCorners::press(const Key& key) {
  auto& corner = projector_px_[chosen_];
  switch (key.arrow) {
    case Key::Arrow::up:
      corner.y -= step_px_;
      return true;
    case Key::Arrow::down:
      corner.y += step_px_;
      return true;
    case Key::Arrow::left:
      corner.x -= step_px_;
      return true;
    case Key::Arrow::right:
      corner.x += step_px_;
      return true;
    case Key::Arrow::none:
      break;
  }
  if (key.character >= '1' && key.character <= '4')
    chosen_ = static_cast<std::size_t>(key.character - '1');
  else if (key.character == '+')
    step_px_ = std::min(2 * step_px_, kMostStep_px);
  else if (key.character == '-')
    step_px_ = std::max(step_px_ / 2, kLeastStep_px);
  else
    return false;
  return true;
}

glm::dmat3 DraggedCorners::homography() const {
  return calib::homography_of_corners(camera_px_, projector_px_);
}

std::string DraggedCorners::state() const {
  return fmt::format("corner {} ({}), steps of {:g} px", chosen_ + 1, kNames[chosen_], step_px_);
}

Result<Outcome> align_by_hand(Desk& desk) {
  if (!desk.keys.has_person())
    return fail(Errc::bad_config,
                "the camera does not see the projector's light, so a person must align it: call "
                "`handcast calibrate` in a terminal");
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  fmt::print(stderr,
             "  The camera does not see the projector's light. Its image is projected: drag its "
             "corners until the image falls\n  onto the things that it shows, at the distance of "
             "the hand. 1 2 3 4: corner, arrows: move, + -: step, Enter: done\n");
  DraggedCorners corners(desk.draft);
  for (;;) {
    if (auto runs = desk.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
    while (const auto key = desk.keys.pressed()) {
      if (key->character == '\n') {
        desk.draft.projector_from_camera = corners.homography();
        desk.draft.parallax = {};
        return Outcome{"aligned by hand at four corners",
                       true,
                       {"the light was not measured: it is right at the distance at which it was "
                        "aligned, and elsewhere only if camera and projector are coaxial"}};
      }
      if (corners.press(*key)) fmt::print(stderr, "\r  {}\033[K", corners.state());
    }
    const auto frame = frames->latest(Deadline::in(200ms));
    if (!frame && frame.error().code != Errc::timeout) return tl::make_unexpected(frame.error());
    if (!frame) continue;
    desk.screen.show([&](std::uint8_t* levels) {
      draw(**frame, desk.draft.camera, glm::inverse(corners.homography()), corners.chosen_px(),
           desk.screen.width_px(), desk.screen.height_px(), levels);
    });
  }
}

}  // namespace handcast::calibrate
