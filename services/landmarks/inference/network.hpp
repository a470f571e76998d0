// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::landmarks {

/// A neural network as read from an ONNX file: float tensors in, float tensors out, batch 1. One
/// thread, one core.
class Network {
 public:
  struct Port {
    std::string name;
    std::vector<int> shape;  ///< as the file declares it, the batch's 1 included

    std::size_t size() const {
      std::size_t count = 1;
      for (const int extent : shape) count *= static_cast<std::size_t>(extent);
      return count;
    }
  };
  virtual ~Network() = default;

  virtual std::span<const Port> inputs() const = 0;
  virtual std::span<const Port> outputs() const = 0;

  /// Where to write input `i` before run(), row-major in its shape.
  virtual std::span<float> input(std::size_t i) = 0;
  /// Errors: bad_data (an output is not finite).
  virtual Result<void> run() = 0;
  /// Valid until the next run(), row-major in its shape.
  virtual std::span<const float> output(std::size_t i) const = 0;
};

/// What runs a network. Errors of open: bad_config, naming the file (missing, no ONNX, an operator
/// or a shape it cannot run, weights that are not finite). A network has been run once when it is
/// returned: the first run() is no slower than the rest.
struct NetworkBackend {
  const char* name;
  Result<std::unique_ptr<Network>> (*open)(const std::filesystem::path& file);
};

std::span<const NetworkBackend> network_backends();

/// `backend`: one of network_backends(). Errors: as of open, and bad_config where there is no such
/// back end.
Result<std::unique_ptr<Network>> open_network(const std::string& backend,
                                              const std::filesystem::path& file);

}  // namespace handcast::landmarks
