// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::renderer {

/// The factor, 0..1, by which a Wiener filter shrinks a value: near 1 if the value is well above
/// the noise, near 0 if it is well below. `square`: the value squared; `noise`: its standard
/// deviation if there is no signal, in the unit of the value.
inline float share_beyond_noise(float square, float noise) {
  return square / (square + noise * noise);
}

}  // namespace handcast::renderer
