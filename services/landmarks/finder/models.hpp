// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

namespace handcast::landmarks {

/// The folder of the networks' files: `configured` (the setting landmarks.models) unless it is
/// empty; else HANDCAST_MODELS; else the first of models/ in the installation's share folder and in
/// the user's own ($XDG_DATA_HOME or ~/.local/share, handcast/models) that is there; else the
/// user's own, where scripts/get-models puts them.
std::filesystem::path models_folder(const std::string& configured);

inline constexpr const char* kHandModel = "hand_landmark_lite.onnx";
inline constexpr const char* kPalmModel = "palm_detection_lite.onnx";

}  // namespace handcast::landmarks
