// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A threshold between the dark and the bright pixels of `region`, which must be inside the image.
/// The two classes are separated by Otsu's method (Otsu 1979) on every second pixel of every eighth
/// row. The threshold is a quarter of the way from the dark mean to the bright mean, because a hand
/// is darker at its edge, but above the noise of the dark pixels. 0 if there are not two classes.
int choose_threshold(GreyView image, Rect region);

}  // namespace handcast::renderer
