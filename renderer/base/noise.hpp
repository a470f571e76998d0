// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::renderer {

/// Of something whose square is `square`: lets through what stands out of the noise, and of the
/// rest little (the shrinkage of a Wiener filter).
inline float share_beyond_noise(float square, float noise) {
  return square / (square + noise * noise);
}

}  // namespace handcast::renderer
