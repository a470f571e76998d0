// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "services/lab/twin/twin.hpp"

namespace handcast::twin {

/// The folder of data that is not in the repository: HANDCAST_DATA or ../shared/data.
inline std::filesystem::path outside_data() {
  if (const char* data = std::getenv("HANDCAST_DATA")) return data;
  const char* source = std::getenv("HANDCAST_SOURCE");
  return std::filesystem::path(source ? source : ".") / ".." / "shared" / "data";
}

/// The default rig with another motion of the twin.
inline config::Rig rig_with(const std::string& motion) {
  config::Rig rig;
  rig.twin.motion = motion;
  return rig;
}

/// A rig whose sensors have neither errors nor delays.
inline config::Rig perfect_rig(const std::string& motion) {
  config::Rig rig = rig_with(motion);
  rig.twin.tracker = {.age_ms = 0,
                      .age_sd_ms = 0,
                      .scale = 1,
                      .offset_mm = 0,
                      .rotation_deg = 0,
                      .drift_px = 0,
                      .noise_mm = 0};
  rig.twin.detector = {.age_ms = 0, .age_sd_ms = 0, .noise_px = 0};
  return rig;
}

/// The twin of a rig; null after a test failure if it cannot be created.
inline std::unique_ptr<Twin> twin_of(const config::Rig& rig) {
  auto twin = Twin::create(rig, calib::reference_rig());
  if (!twin) {
    ADD_FAILURE() << twin.error().what;
    return nullptr;
  }
  return std::move(*twin);
}

inline glm::dvec3 place(const glm::mat4& frame) { return glm::dvec3(frame[3]); }

}  // namespace handcast::twin

/// Skips the test if the recordings outside the repository are missing.
#define HANDCAST_NEEDS_RECORDINGS()                                                \
  if (!std::filesystem::exists(handcast::twin::outside_data() / "lmc" / "all_5s")) \
  GTEST_SKIP() << "no recordings in " << (handcast::twin::outside_data() / "lmc")  \
               << "; HANDCAST_DATA names another folder"
