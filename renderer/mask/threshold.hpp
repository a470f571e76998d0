// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A grey value between the dark and the bright part of `region` (Otsu 1979), from every second
/// pixel of every fourth row: a quarter of the way from the dark part's mean to the bright one's,
/// because a hand is darker at its rim, but clear of the ground's noise. 0 where the region has no
/// two parts.
int choose_threshold(GreyView image, Rect region);

}  // namespace handcast::renderer
