// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

/// That the graph is one: known extents, each value made once and before it is used, finite
/// constants.
Result<void> check_model(const Model& model);

}  // namespace handcast::landmarks::onnx
