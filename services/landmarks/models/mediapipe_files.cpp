// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_files.hpp"

#include <fmt/format.h>

namespace handcast::landmarks {
namespace {

namespace fs = std::filesystem;

std::string shapes_of(std::span<const Network::Port> ports) {
  std::string text;
  for (const auto& port : ports)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", fmt::join(port.shape, "x"));
  return text;
}

bool has_shapes(const Network& network, const NetworkShapes& expected) {
  if (network.inputs().size() != 1 || network.inputs()[0].shape != expected.input) return false;
  if (network.outputs().size() != expected.outputs.size()) return false;
  for (std::size_t i = 0; i < expected.outputs.size(); ++i)
    if (network.outputs()[i].shape != expected.outputs[i]) return false;
  return true;
}

}  // namespace

Result<std::unique_ptr<Network>> open_mediapipe_network(const fs::path& file,
                                                        const NetworkShapes& expected) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    return fail(
        Errc::bad_config,
        fmt::format("'{}' is missing; scripts/get-models fetches it, or set models to its folder",
                    file.string()));
  auto network = open_network(file);
  if (!network) return network;
  if (!has_shapes(**network, expected))
    return fail(Errc::bad_config,
                fmt::format("'{}' is not {}: its inputs are {} and its outputs {}", file.string(),
                            expected.name, shapes_of((*network)->inputs()),
                            shapes_of((*network)->outputs())));
  return network;
}

}  // namespace handcast::landmarks
