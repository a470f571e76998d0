// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

/// The model as the bytes of an ONNX file.
std::vector<std::uint8_t> write_model(const Model& model);

}  // namespace handcast::landmarks::onnx
