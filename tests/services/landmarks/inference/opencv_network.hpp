// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks {

/// Opens a network in OpenCV's dnn module, with one thread: the oracle of ours. Errors: as
/// open_network().
Result<std::unique_ptr<Network>> open_opencv_network(const std::filesystem::path& file);

namespace onnx {
/// Rewrites what OpenCV 4.6 does not support without changing the network's function: Clip with
/// bounds as inputs, Squeeze with axes as an input, Gemm with weights that are not transposed.
/// Removes constants that are no longer used.
void adapt_for_opencv(Model& model);
}  // namespace onnx

}  // namespace handcast::landmarks
