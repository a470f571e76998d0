// SPDX-License-Identifier: Apache-2.0
#include "tests/system/filmed_hands.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/camera_scene.hpp"

namespace handcast::system_test {
namespace {

/// The camera as its sensor has it, with half of the rows.
calib::PlacedCamera sensor_of(calib::PlacedCamera seen) {
  auto& camera = seen.model;
  camera.height_px /= 2;
  camera.fy_px /= 2;
  camera.cy_px = (camera.cy_px + 0.5) / 2 - 0.5;
  return seen;
}

}  // namespace

FilmedHands::FilmedHands(const config::Rig& rig, const calib::Calibration& calibration, int images,
                         std::int64_t period_ns)
    : twin_(twin::Twin::create(rig, calib::reference_rig()).value()), period_ns_(period_ns) {
  const auto truth = [this](msg::Side side, std::int64_t time_ns) {
    return twin_->joints(side, time_ns);
  };
  images_.resize(static_cast<std::size_t>(images));
  renderer::Image<std::uint8_t> drawn(kWidth_px, kHeight_px);
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const auto seen =
        sensor_of(calib::camera_at(calibration, static_cast<config::Viewpoint>(eye)).value());
    twin::CameraScene scene(rig.twin.image, rig.twin.seed + static_cast<int>(eye), seen);
    for (const auto side : {msg::Side::left, msg::Side::right})
      if (twin_->joints(side, 0)) scene.set_hand(side, twin_->true_hand(side));
    for (std::size_t k = 0; k < images_.size(); ++k) {
      scene.draw(k, static_cast<std::int64_t>(k) * period_ns, ms_to_ns(rig.camera.exposure_ms),
                 truth, drawn.view());
      auto& both = images_[k];
      both.resize(std::size_t{2} * kWidth_px * kHeight_px);
      for (int y = 0; y < kHeight_px; ++y)
        for (int x = 0; x < kWidth_px; ++x)
          both[2 * (static_cast<std::size_t>(y) * kWidth_px + x) + eye] = drawn.at(x, y);
    }
  }
}

void FilmedHands::write(std::uint32_t number, std::span<std::uint8_t> both) const {
  const auto last = static_cast<std::uint32_t>(images_.size() - 1), turn = number % (2 * last);
  std::ranges::copy(images_[turn <= last ? turn : 2 * last - turn], both.begin());
}

std::optional<renderer::JointFrames> FilmedHands::joints(msg::Side side,
                                                         std::int64_t since_ns) const {
  const auto last_ns = static_cast<std::int64_t>(images_.size() - 1) * period_ns_,
             turn_ns = since_ns % (2 * last_ns);
  return twin_->joints(side, turn_ns <= last_ns ? turn_ns : 2 * last_ns - turn_ns);
}

}  // namespace handcast::system_test
