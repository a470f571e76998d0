#pragma once
#include "renderer/image.hpp"

namespace handcast::renderer {

/// A grey value between the dark and the bright part of `region` (Otsu 1979), from every second pixel of every second row: two fifths of
/// the way from the dark part's mean to the bright one's, because a hand is darker at its rim. 0 where the region has no two parts.
int choose_threshold(GreyView image, Rect region);

}  // namespace handcast::renderer
