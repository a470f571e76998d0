#pragma once
#include "services/landmarks/network/onnx/model.hpp"

namespace handcast::landmarks::onnx {

/// That the graph is one: known extents, each value made once and before it is used, finite constants.
Result<void> check_model(const Model& model);

}  // namespace handcast::landmarks::onnx
