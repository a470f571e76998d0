// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onednn {

/// A node, and the additions and activations after it that nothing else looks into: they may run
/// while its result is in registers.
struct Group {
  onnx::Node head;
  std::vector<onnx::Node> tail;  ///< each takes the result of the one before it

  const std::string& output() const {
    return tail.empty() ? head.outputs[0] : tail.back().outputs[0];
  }
};

/// The graph as groups, in an order that makes every input before it is used.
std::vector<Group> fuse(const onnx::Model& model);

}  // namespace handcast::landmarks::onednn
