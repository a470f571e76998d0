// SPDX-License-Identifier: Apache-2.0
// A calibration file; then what the renderer computes with it.
// Limits: 10 s and 1 GB per input.
#include "calib/calibration.hpp"

#include <cmath>

#include "tests/fuzz/input.hpp"

namespace {

void use(const handcast::calib::Calibration& calibration) {
  using handcast::fuzz::require;
  const glm::dvec2 last(calibration.projector.width_px - 1, calibration.projector.height_px - 1);
  for (int i = 0; i < 25; ++i) {
    const auto camera_px =
        calibration.projector.camera_pixel_of(last * glm::dvec2(i % 5, i / 5) / 4.0);
    require(std::isfinite(camera_px.x) && std::isfinite(camera_px.y));
    const auto lens_px = calibration.camera.distort(camera_px);
    calibration.camera.undistort(lens_px);
    const auto back_px = calibration.projector.pixel_of(camera_px);
    require(std::isfinite(back_px.x) && std::isfinite(back_px.y));
  }
  require(std::isfinite(calibration.mm_per_projector_px(1)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  static fuzz::MemoryFile file;
  file.write({data, size});
  const auto calibration = calib::load_calibration(file.path());
  if (!calibration) {
    fuzz::require(calibration.error().code == Errc::bad_config);
    return 0;
  }
  use(*calibration);
  const auto printed = calib::print_calibration(*calibration);
  file.write({reinterpret_cast<const std::uint8_t*>(printed.data()), printed.size()});
  fuzz::require(calib::load_calibration(file.path()).has_value());
  return 0;
}
