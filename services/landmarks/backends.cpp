// SPDX-License-Identifier: Apache-2.0
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

/// One row for each landmark model; open_network_detector finds out which from landmarks.backend.
static std::vector<DetectorBackend> make_table() {
  std::vector<DetectorBackend> table;
  for (const auto& model : landmark_models()) table.push_back({model.name, open_network_detector});
  table.push_back({"twin", open_twin});
  table.push_back({"replay", open_replay});
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
