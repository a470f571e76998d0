// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "renderer/base/image.hpp"
#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::detect {

/// The picture, made bright enough to be seen, with each hand's bones and landmarks, the region it
/// was looked for in (its upper edge thick) and the tracker's joints as crosses.
renderer::Texture draw(renderer::GreyView picture, std::span<const landmarks::FoundHand> hands,
                       const landmarks::Hints& hints_px);

}  // namespace handcast::detect
