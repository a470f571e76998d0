// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "config/settings/setting_list.hpp"
#include "services/landmarks/models/landmark_model.hpp"
#include "services/landmarks/models/mediapipe_palm_network.hpp"

namespace handcast::landmarks {

/// The options of a model.
struct ModelOptions {
  std::filesystem::path folder;  ///< folder of MediaPipe's files; see models_folder()
  /// File of handcast's network; empty: the one that comes with handcast.
  std::filesystem::path handcast_network;
};

/// A landmark model and a palm network.
struct OpenedModel {
  std::unique_ptr<LandmarkModel> landmarks;  ///< the model
  /// Searches a whole image for hands that neither the tracker nor the last image shows. Empty if
  /// its file is missing and the model works without it.
  std::optional<MediapipePalmNetwork> palms;
};

/// A row of the table of landmark models.
struct LandmarkModelRow {
  std::string_view name;      ///< as landmarks.backend has it
  std::string_view sentence;  ///< what it is, for handcast-landmarks --backends
  Result<OpenedModel> (*open)(const ModelOptions& options);  ///< see open_landmark_model()
  /// The files without which it cannot be opened.
  std::vector<std::filesystem::path> (*files)(const ModelOptions& options);
  config::SettingList reads;  ///< the settings that it depends on
};

/// All landmark models.
std::span<const LandmarkModelRow> landmark_models();

/// Opens the model called `name`. Errors: bad_config (no such model; a file is missing or holds
/// another network, or one that cannot be run).
Result<OpenedModel> open_landmark_model(std::string_view name, const ModelOptions& options);

/// The first file that the model called `name` needs and that does not exist. Empty if there is
/// none, also if there is no such model.
std::filesystem::path missing_file(std::string_view name, const ModelOptions& options);

}  // namespace handcast::landmarks
