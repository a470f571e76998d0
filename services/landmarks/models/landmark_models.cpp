// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/landmark_models.hpp"

#include <fmt/format.h>

#include <string>

#include "services/landmarks/models/handcast_model.hpp"
#include "services/landmarks/models/mediapipe_model.hpp"

namespace handcast::landmarks {

static constexpr config::SettingList kReads{"landmarks.models", "landmarks.hands", "pose.backend"};

static constexpr std::array kModels{
    LandmarkModelRow{.name = "handcast",
                     .sentence = "handcast's own network, which also reads the tracker's joints.",
                     .open = open_handcast_model,
                     .files = handcast_files,
                     .reads = kReads},
    LandmarkModelRow{.name = "mediapipe",
                     .sentence = "MediaPipe Hands lite, whose files scripts/get-models fetches.",
                     .open = open_mediapipe_model,
                     .files = mediapipe_files,
                     .reads = kReads},
};

std::span<const LandmarkModelRow> landmark_models() { return kModels; }

Result<OpenedModel> open_landmark_model(std::string_view name, const ModelOptions& options) {
  std::string known;
  for (const auto& model : kModels) {
    if (model.name == name) return model.open(options);
    known += fmt::format("{}{}", known.empty() ? "" : ", ", model.name);
  }
  return fail(Errc::bad_config,
              fmt::format("there is no landmark model '{}'; there are: {}", name, known));
}

std::filesystem::path missing_file(std::string_view name, const ModelOptions& options) {
  for (const auto& model : kModels) {
    if (model.name != name) continue;
    for (auto& file : model.files(options)) {
      std::error_code ignored;
      if (!std::filesystem::exists(file, ignored)) return std::move(file);
    }
  }
  return {};
}

}  // namespace handcast::landmarks
