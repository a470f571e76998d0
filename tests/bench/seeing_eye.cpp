// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/seeing_eye.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "services/camera/leap/deinterleave.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

/// The camera as its sensor has it, with fewer rows.
calib::PlacedCamera sensor_of(calib::PlacedCamera seen, int rows_per_row) {
  auto& camera = seen.model;
  camera.height_px /= rows_per_row;
  camera.fy_px /= rows_per_row;
  camera.cy_px = (camera.cy_px + 0.5) / rows_per_row - 0.5;
  return seen;
}

}  // namespace

Result<std::unique_ptr<SeeingEye>> SeeingEye::open(const calib::Calibration& calibration,
                                                   config::Viewpoint at, int rows_per_row,
                                                   const config::Rig& rig, const twin::Twin& twin) {
  auto camera = calib::camera_at(calibration, at);
  if (!camera) return tl::make_unexpected(camera.error());
  auto detector = landmarks::open_detector(rig, calibration, 0, at);
  if (!detector) return tl::make_unexpected(detector.error());
  return std::unique_ptr<SeeingEye>(new SeeingEye(calibration, at, std::move(*camera), rows_per_row,
                                                  rig, twin, std::move(*detector)));
}

SeeingEye::SeeingEye(const calib::Calibration& calibration, config::Viewpoint at,
                     calib::PlacedCamera camera, int rows_per_row, const config::Rig& rig,
                     const twin::Twin& twin, std::unique_ptr<landmarks::Detector> detector)
    : twin_(twin),
      calibration_(calibration),
      at_(at),
      camera_(std::move(camera)),
      rig_(rig),
      scene_(rig.twin.image, rig.twin.seed, sensor_of(camera_, rows_per_row)),
      exposure_ns_(ms_to_ns(rig.camera.exposure_ms)),
      detector_(std::move(detector)),
      hints_(camera_),
      sensor_(camera_.model.width_px, camera_.model.height_px / rows_per_row),
      frame_(msg::CameraFrame::bytes(camera_.model.width_px, camera_.model.height_px)) {
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (twin.joints(side, 0)) scene_.set_hand(side, twin.true_hand(side));
  frame_->width_px = static_cast<std::uint32_t>(camera_.model.width_px);
  frame_->height_px = static_cast<std::uint32_t>(camera_.model.height_px);
}

Result<void> SeeingEye::forget() {
  auto detector = landmarks::open_detector(rig_, calibration_, 0, at_);
  if (!detector) return tl::make_unexpected(detector.error());
  detector_ = std::move(*detector);
  hints_ = landmarks::TrackerHints(camera_);
  return {};
}

Result<msg::Landmarks> SeeingEye::look(std::uint64_t k, std::int64_t time_ns, bool hints) {
  const auto truth = [this](msg::Side side, std::int64_t at_ns) {
    return twin_.joints(side, at_ns);
  };
  scene_.draw(k, time_ns, exposure_ns_, truth, sensor_.view());
  write_frame();
  frame_->header = {k, time_ns, 0};
  return detector_->detect(*frame_, hints ? hints_.at(time_ns) : landmarks::Hints{},
                           Deadline::in(1h));
}

void SeeingEye::write_frame() {
  const auto sensor = sensor_.view();
  both_.clear();
  for (int y = 0; y < sensor.height; ++y)
    for (int x = 0; x < sensor.width; ++x) both_.insert(both_.end(), 2, sensor.at(x, y));
  const auto pixels = static_cast<std::size_t>(frame_->width_px) * frame_->height_px;
  camera::leap::deinterleave(both_, 0, sensor.width, {frame_->pixels(), pixels});
}

std::vector<Miss> SeeingEye::compare(const msg::Landmarks& seen) const {
  const auto& camera = camera_.model;
  const glm::dvec2 square(1, camera.fx_px / camera.fy_px);
  std::vector<Miss> misses;
  for (std::uint32_t h = 0; h < seen.count; ++h) {
    const auto truth = twin_.joints(seen.hands[h].side, seen.header.origin_ns);
    if (!truth) continue;
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const glm::dvec3 at_m(camera_.from_tracker *
                            glm::dvec4((*truth)[msg::kJointOfLandmark[i]][3]));
      const auto& point = seen.hands[h].points[i];
      const glm::dvec3 ray((point.x_px - camera.cx_px) / camera.fx_px,
                           (point.y_px - camera.cy_px) / camera.fy_px, 1);
      const double px =
          glm::length(square * (camera.project(at_m) - glm::dvec2(point.x_px, point.y_px)));
      const double sine = glm::length(glm::cross(glm::normalize(ray), glm::normalize(at_m)));
      misses.push_back({.px = px,
                        .deg = glm::degrees(std::asin(std::min(sine, 1.0))),
                        .mm = 1e3 * px * at_m.z / camera.fx_px});
    }
  }
  return misses;
}

}  // namespace handcast::bench
