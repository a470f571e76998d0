// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "services/evaluation/twin/settings.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/models/landmark_models.hpp"

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
    .reads = twin::kWorldSettings + config::SettingList{"twin.detector", "twin.image.delivery_ms",
                                                        "twin.image.lost", "twin.image.burst",
                                                        "twin.image.clock_drift_ppm",
                                                        "twin.image.clock_jitter_ms",
                                                        "camera.rate_hz", "camera.exposure_ms"}};

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

Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns) {
  return service::open_backend("landmarks", rig.landmarks.backend, detector_backends(), rig,
                               calibration, epoch_ns);
}

}  // namespace handcast::landmarks
