// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "services/landmarks/inference/network.hpp"

namespace handcast::landmarks {

/// The names of MediaPipe's files in models_folder().
/// @{
inline constexpr const char* kMediapipeHandFile = "hand_landmark_lite.onnx";
inline constexpr const char* kMediapipePalmFile = "palm_detection_lite.onnx";
/// @}

/// The shapes by which a network is recognised.
struct NetworkShapes {
  const char* name;                       ///< name of the network, for messages
  std::vector<int> input;                 ///< shape of its only input
  std::vector<std::vector<int>> outputs;  ///< shapes of its outputs
};

/// Opens one of MediaPipe's files. Errors (bad_config): it is missing, its shapes are not those
/// expected, or those of open_network().
Result<std::unique_ptr<Network>> open_mediapipe_network(const std::filesystem::path& file,
                                                        const NetworkShapes& expected);

}  // namespace handcast::landmarks
