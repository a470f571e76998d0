// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/luminance.hpp"

#include "renderer/base/clones.hpp"

namespace handcast::renderer {

HANDCAST_CLONES void luminances(const std::uint32_t* __restrict rgba, int count,
                                std::uint16_t* __restrict out) {
  for (int x = 0; x < count; ++x) out[x] = luminance(rgba[x]);
}

}  // namespace handcast::renderer
