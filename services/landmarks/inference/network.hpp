// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::landmarks {

/// A neural network read from an ONNX file: float tensors in, float tensors out, batch size 1. Runs
/// on one core. One thread.
class Network {
 public:
  /// An input or an output.
  struct Port {
    std::string name;        ///< its name in the file
    std::vector<int> shape;  ///< as the file declares it, with the batch size

    /// The number of elements.
    std::size_t size() const {
      std::size_t count = 1;
      for (const int extent : shape) count *= static_cast<std::size_t>(extent);
      return count;
    }
  };
  virtual ~Network() = default;

  /// The inputs in the order of the file.
  virtual std::span<const Port> inputs() const = 0;
  /// The outputs in the order of the file.
  virtual std::span<const Port> outputs() const = 0;

  /// The elements of input `i`, row-major in its shape. Write them before run().
  virtual std::span<float> input(std::size_t i) = 0;
  /// Computes the outputs. Errors: bad_data (an output is not finite).
  virtual Result<void> run() = 0;
  /// The elements of output `i`, row-major in its shape; valid until the next run().
  virtual std::span<const float> output(std::size_t i) const = 0;
};

/// Opens a network and runs it once, so that its first run() is no slower than the others. Errors
/// (bad_config): the file is missing or is not an ONNX file, or it has an operator or a shape that
/// is not supported, or weights that are not finite.
Result<std::unique_ptr<Network>> open_network(const std::filesystem::path& file);

}  // namespace handcast::landmarks
