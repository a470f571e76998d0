// SPDX-License-Identifier: Apache-2.0
#include "config/renamed_settings.hpp"

#include <array>

#include "ipc/base/log.hpp"

namespace handcast::config {

static constexpr std::array kRenamed{
    // The back end named what ran MediaPipe's network.
    Renamed{.old = {"landmarks.backend", "own"}, .now = {"landmarks.backend", "handcast"}},
    Renamed{.old = {"landmarks.backend", "onednn"}, .now = {"landmarks.backend", "mediapipe"}},
    Renamed{.old = {"landmarks.backend", "opencv"}, .now = {"landmarks.backend", "mediapipe"}},
};

std::span<const Renamed> renamed_settings() { return kRenamed; }

void log_renamed(const std::string& sentence) { log::warning("{}", sentence); }

}  // namespace handcast::config
