// SPDX-License-Identifier: Apache-2.0
// The calibration in the memory of a Leap Motion Controller: two bytes of the image's size, then
// the block. Limits: 10 s and 1 GB per input.
#include <cmath>

#include "services/camera/leap/calibration_block.hpp"
#include "services/camera/leap/lens_fit.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  using namespace handcast::camera::leap;
  fuzz::Reader input({data, size});
  const int width_px = 16 + 4 * input.number<std::uint8_t>();
  const int height_px = 16 + 4 * input.number<std::uint8_t>();
  const auto calibration = parse_calibration(input.take(size));
  if (!calibration) {
    fuzz::require(!calibration.error().what.empty());
    return 0;
  }
  const auto pose = right_from_left(*calibration);
  for (int i = 0; i < 4; ++i) fuzz::require(std::isfinite(glm::length(pose[i])));
  for (const auto& eye : {calibration->left, calibration->right}) {
    const auto fit = fit_lens(eye, width_px, height_px);
    if (!fit) continue;
    fuzz::require(std::isfinite(fit->rms_px) && std::isfinite(fit->worst_px));
    fuzz::require(!fit->camera.folds());
  }
  return 0;
}
