// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "renderer/base/image.hpp"
#include "services/landmarks/finder/found_hand.hpp"
#include "services/landmarks/geometry/points.hpp"

namespace handcast::detect {

/// The picture, brightened, with each hand's bones and landmarks, its region (with a thick upper
/// edge) and the tracker's joints as crosses.
renderer::Texture draw(renderer::GreyView picture, std::span<const landmarks::FoundHand> hands,
                       const landmarks::Hints& hints_px);

}  // namespace handcast::detect
