// SPDX-License-Identifier: Apache-2.0
#include "calib/sub_frames.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "config/sections/sub_frames.hpp"
#include "config/settings/choice.hpp"

namespace handcast::calib {

Calibration with_scaled_projector(const Calibration& calibration, double factor) {
  Calibration scaled = calibration;
  scaled.projector.width_px =
      static_cast<int>(std::lround(calibration.projector.width_px * factor));
  scaled.projector.height_px =
      static_cast<int>(std::lround(calibration.projector.height_px * factor));
  // The edge of the image stays where it is, half a pixel from the centre of the first pixel.
  const double shift_px = (factor - 1) / 2;
  const glm::dmat3 scale(factor, 0, 0, 0, factor, 0, shift_px, shift_px, 1);
  scaled.projector.from_camera = scale * calibration.projector.from_camera;
  scaled.projector.parallax = scale * calibration.projector.parallax;
  return scaled;
}

Result<Calibration> load_calibration(const std::filesystem::path& file, config::Packing packing) {
  auto calibration = load_calibration(file);
  if (!calibration || !config::has_half_size(packing)) return calibration;
  const int width_px = calibration->projector.width_px,
            height_px = calibration->projector.height_px;
  if (width_px % 2 != 0 || height_px % 2 != 0)
    return fail(Errc::bad_config,
                fmt::format("projector.packing = \"{}\" needs a projector image of even width and "
                            "height; the calibration has {}x{}",
                            config::word_of(packing), width_px, height_px));
  return with_scaled_projector(*calibration, 0.5);
}

static bool is_same(const CameraModel& a, const CameraModel& b) {
  const auto numbers = [](const CameraModel& c) {
    return std::array{c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
  };
  return a.width_px == b.width_px && a.height_px == b.height_px && numbers(a) == numbers(b);
}

Result<Calibration> load_calibration(const std::filesystem::path& file,
                                     const config::Projector& first,
                                     const config::SecondProjector& second) {
  auto calibration = load_calibration(file, first.packing);
  if (!calibration || second.backend == "none") return calibration;
  if (second.calibration.empty())
    return fail(
        Errc::bad_config,
        "projector2.calibration is empty: a second projector needs a calibration of its own, "
        "which `handcast calibrate --second-projector` makes");
  auto other = load_calibration(second.calibration, second.packing);
  if (!other) return fail_in("projector2.calibration", other.error());
  if (!is_same(calibration->camera, other->camera))
    return fail(Errc::bad_config,
                fmt::format("projector2.calibration: {} has another lens of the camera than the "
                            "calibration of the rig; measure it anew with `handcast calibrate "
                            "--second-projector`",
                            second.calibration));
  calibration->projector2 = SecondProjector{other->projector_device, other->projector};
  return calibration;
}

Calibration output_of(const Calibration& sub_frame, config::Packing packing) {
  return config::has_half_size(packing) ? with_scaled_projector(sub_frame, 2) : sub_frame;
}

}  // namespace handcast::calib
