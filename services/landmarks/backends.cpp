// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "config/sections/twin/world_settings.hpp"
#include "ipc/base/join.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/models_folder.hpp"

namespace handcast::landmarks {

Result<std::unique_ptr<Detector>> open_network_detector(const config::Rig&,
                                                        const calib::Calibration&,
                                                        const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_twin(const config::Rig&, const calib::Calibration&,
                                            const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_replay(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);

static constexpr DetectorBackend kTwin{
    .name = "twin",
    .sentence = "Models a landmark detector that sees the twin's hand.",
    .open = open_twin,
    .reads =
        config::kTwinWorldSettings +
        config::SettingList{"twin.detector", "twin.image.delivery_ms", "twin.image.lost",
                            "twin.image.burst", "twin.image.clock_drift_ppm",
                            "twin.image.clock_jitter_ms", "camera.rate_hz", "camera.exposure_ms"}};

static constexpr DetectorBackend kReplay{.name = "replay",
                                         .sentence = "Plays recorded landmarks.",
                                         .open = open_replay,
                                         .reads = {"landmarks.replay"}};

/// One row for each landmark model, all with open_network_detector, which opens the model that
/// landmarks.backend names.
static std::vector<DetectorBackend> make_table() {
  std::vector<DetectorBackend> table;
  for (const auto& model : landmark_models())
    table.push_back({.name = model.name,
                     .sentence = model.sentence,
                     .open = open_network_detector,
                     .reads = model.reads});
  table.push_back(kTwin);
  table.push_back(kReplay);
  return table;
}

std::span<const DetectorBackend> detector_backends() {
  static const std::vector<DetectorBackend> kBackends = make_table();
  return kBackends;
}

DetectorChoice choose_detector(const config::Rig& rig) {
  const auto& settings = rig.landmarks;
  // A folder that does not exist is a wrong setting and not a missing file.
  const auto folder = models_folder(settings.models);
  if (settings.fallback.empty() || !folder) return {settings.backend, {}};
  const auto missing = missing_file(settings.backend, {.folder = *folder});
  if (missing.empty()) return {settings.backend, {}};
  return {settings.fallback,
          fmt::format("landmarks: '{}' is missing, so '{}' takes the place of '{}' "
                      "(landmarks.fallback)",
                      missing.string(), settings.fallback, settings.backend)};
}

Result<void> check_fallback(const config::Rig& rig) {
  const auto& fallback = rig.landmarks.fallback;
  const auto names = service::names_of(detector_backends());
  if (fallback.empty() || std::ranges::find(names, fallback) != names.end()) return {};
  return fail(Errc::bad_config,
              fmt::format("landmarks.fallback: there is no back end '{}'; there are: {}", fallback,
                          join(names, ", ")));
}

Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns) {
  if (auto known = check_fallback(rig); !known) return tl::make_unexpected(known.error());
  auto chosen = rig;
  chosen.landmarks.backend = choose_detector(rig).backend;
  return service::open_backend("landmarks", chosen.landmarks.backend, detector_backends(), chosen,
                               calibration, epoch_ns);
}

}  // namespace handcast::landmarks
