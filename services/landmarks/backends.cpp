// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "services/landmarks/detector.hpp"

namespace handcast::landmarks {

Result<std::unique_ptr<Detector>> open_onednn(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_opencv(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_own(const config::Rig&, const calib::Calibration&,
                                           const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_twin(const config::Rig&, const calib::Calibration&,
                                            const std::int64_t& epoch_ns);
Result<std::unique_ptr<Detector>> open_replay(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);

static constexpr std::array kBackends{
    DetectorBackend{"onednn", open_onednn}, DetectorBackend{"opencv", open_opencv},
    DetectorBackend{"own", open_own},       DetectorBackend{"twin", open_twin},
    DetectorBackend{"replay", open_replay},
};

std::span<const DetectorBackend> detector_backends() { return kBackends; }

Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns) {
  return service::open_backend("landmarks", rig.landmarks.backend, detector_backends(), rig,
                               calibration, epoch_ns);
}

}  // namespace handcast::landmarks
