// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <vector>

#include "config/sections/twin/world_settings.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/models_folder.hpp"

namespace handcast::landmarks {

Result<std::unique_ptr<Detector>> open_network_detector(const Opening&);
Result<std::unique_ptr<Detector>> open_twin(const Opening&);
Result<std::unique_ptr<Detector>> open_replay(const Opening&);
Result<std::unique_ptr<Detector>> open_external(const Opening&);

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

static constexpr DetectorBackend kExternal{
    .name = "external",
    .sentence = "A program of your own, in any language, by handcast.h.",
    .open = open_external,
    .check = service::kSeenWhenUp};

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
  table.push_back(kExternal);
  return table;
}

std::span<const DetectorBackend> detector_backends() {
  static const std::vector<DetectorBackend> kBackends = make_table();
  return kBackends;
}

DetectorChoice choose_detector(const config::Rig& rig, config::Viewpoint at) {
  const auto& settings = config::landmarks_at(rig, at);
  // A folder that does not exist is a wrong setting and not a missing file.
  const auto folder = models_folder(settings.models);
  if (settings.fallback.empty() || !folder) return {settings.backend, {}};
  const auto missing = missing_file(settings.backend, {.folder = *folder});
  if (missing.empty()) return {settings.backend, {}};
  return {settings.fallback,
          fmt::format("{0}: '{1}' is missing, so '{2}' takes the place of '{3}' ({0}.fallback)",
                      config::name_at(at, "landmarks"), missing.string(), settings.fallback,
                      settings.backend)};
}

/// Errors: bad_config (its fallback names no back end, or the calibration has no such camera).
static Result<Opening> opening_of(const config::Rig& rig, const calib::Calibration& calibration,
                                  std::int64_t epoch_ns, config::Viewpoint at) {
  auto settings = config::landmarks_at(rig, at);
  const auto name = config::name_at(at, "landmarks");
  if (!settings.fallback.empty())
    if (const auto known = service::find_backend(name, settings.fallback, detector_backends());
        !known)
      return fail_in(name + ".fallback", known.error());
  auto camera = calib::camera_at(calibration, at);
  if (!camera) return tl::make_unexpected(camera.error());
  settings.backend = choose_detector(rig, at).backend;
  return Opening{rig, calibration, epoch_ns, at, std::move(settings), std::move(*camera)};
}

Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns, config::Viewpoint at,
                                                const ipc::OpenRing& ring) {
  auto with = opening_of(rig, calibration, epoch_ns, at);
  if (!with) return tl::make_unexpected(with.error());
  with->ring = ring;
  const auto name = config::name_at(at, "landmarks");
  const auto row = service::find_backend(name, with->settings.backend, detector_backends());
  if (!row) return tl::make_unexpected(row.error());
  return service::in_backend(name, row->name, row->open(*with));
}

Result<void> check_detector(const config::Rig& rig, const calib::Calibration& calibration,
                            config::Viewpoint at) {
  const auto with = opening_of(rig, calibration, now_ns(), at);
  if (!with) return tl::make_unexpected(with.error());
  const auto name = config::name_at(at, "landmarks");
  const auto row = service::find_backend(name, with->settings.backend, detector_backends());
  if (!row) return tl::make_unexpected(row.error());
  return service::in_backend(name, row->name, row->examine(*with));
}

}  // namespace handcast::landmarks
