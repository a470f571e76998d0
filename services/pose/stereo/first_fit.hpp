// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "services/pose/stereo/fit_views.hpp"

namespace handcast::pose::stereo {

/// True if both views see the hand.
bool sees_both(const SeenInViews& seen);
/// True if both views see nearly the whole hand.
bool sees_all(const SeenInViews& seen);

/// The hand that these landmarks show if nothing is known of it but the lengths of its bones: the
/// best of the fits from several postures. A hand that one view alone sees is put at the distance
/// at which its size is usual. Empty if no view sees it, or it is in front of no camera.
std::optional<HandFit> first_fit(const Skeleton& skeleton, const Views& views,
                                 const SeenInViews& seen, const HandPrior& bones);

}  // namespace handcast::pose::stereo
