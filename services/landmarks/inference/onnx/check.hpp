// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

/// Checks that the graph is valid: fixed extents, each value computed once and before it is used,
/// finite constants. Errors: bad_config.
Result<void> check_model(const Model& model);

}  // namespace handcast::landmarks::onnx
