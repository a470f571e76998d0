// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/deinterleave.hpp"

namespace handcast::camera::leap {

void deinterleave(std::span<const std::uint8_t> both, std::size_t eye,
                  std::span<std::uint8_t> image) {
  const std::uint8_t* from = both.data() + eye;
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = from[2 * i];
}

}  // namespace handcast::camera::leap
