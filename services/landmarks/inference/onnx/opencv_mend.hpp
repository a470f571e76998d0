// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

/// Rewrites what OpenCV 4.6 refuses, leaving the function of the network as it is: Clip with its
/// bounds as inputs, Squeeze with its axes as an input, Gemm with weights that are not transposed.
/// Weights that nothing needs any more are dropped.
void mend_for_opencv(Model& model);

}  // namespace handcast::landmarks::onnx
