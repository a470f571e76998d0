// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "services/evaluation/twin/settings.hpp"
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
    DetectorBackend{.name = "onednn",
                    .sentence = "MediaPipe Hands lite, run by oneDNN.",
                    .open = open_onednn,
                    .reads = {"landmarks.models", "landmarks.hands", "landmarks.definition"}},
    DetectorBackend{.name = "opencv",
                    .sentence = "MediaPipe Hands lite, run by OpenCV.",
                    .open = open_opencv,
                    .reads = {"landmarks.models", "landmarks.hands", "landmarks.definition"}},
    DetectorBackend{.name = "own",
                    .sentence = "handcast's own network, which also takes the tracker's joints.",
                    .open = open_own,
                    .reads = {"landmarks.models", "landmarks.hands"}},
    DetectorBackend{.name = "twin",
                    .sentence = "Models a landmark detector that sees the twin's hand.",
                    .open = open_twin,
                    .reads = twin::kWorldSettings +
                             config::SettingList{"twin.detector", "twin.image.delivery_ms",
                                                 "camera.rate_hz", "camera.exposure_ms"}},
    DetectorBackend{.name = "replay",
                    .sentence = "Plays recorded landmarks.",
                    .open = open_replay,
                    .reads = {"landmarks.replay"}},
};

std::span<const DetectorBackend> detector_backends() { return kBackends; }

Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns) {
  return service::open_backend("landmarks", rig.landmarks.backend, detector_backends(), rig,
                               calibration, epoch_ns);
}

}  // namespace handcast::landmarks
