// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onednn {

/// A node and the additions and activations after it whose inputs no other node uses. They may run
/// while the node's result is in registers.
struct Group {
  onnx::Node head;               ///< the node
  std::vector<onnx::Node> tail;  ///< each uses the result of the one before it

  /// The name of the group's result.
  const std::string& output() const {
    return tail.empty() ? head.outputs[0] : tail.back().outputs[0];
  }
};

/// The graph as groups, in an order in which every input is computed before it is used.
std::vector<Group> fuse(const onnx::Model& model);

}  // namespace handcast::landmarks::onednn
