// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "services/content/source.hpp"

namespace handcast::trial {

/// What a projector shows to put a picture onto a hand: its whole image, dark beside the hand but
/// for a few pixels that continue its outline, so that the content "view:" takes no dark from
/// there. `hand` has a surface; `picture` is in its texture coordinates.
renderer::Texture projected(const content::HandState& hand, const renderer::Texture& picture,
                            const calib::Calibration& calibration);

}  // namespace handcast::trial
