// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/setting_list.hpp"

namespace handcast::config {

/// The settings that Twin::create reads: the true person, its motion and what replaces it. Every
/// back end on the twin depends on them.
inline constexpr SettingList kTwinWorldSettings{"twin.motion", "twin.hands", "twin.speed",
                                                "twin.seed",   "twin.shape", "twin.geometry",
                                                "twin.prop",   "hand"};

}  // namespace handcast::config
