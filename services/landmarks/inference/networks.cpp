// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "services/landmarks/inference/network.hpp"

namespace handcast::landmarks {

Result<std::unique_ptr<Network>> open_onednn_network(const std::filesystem::path& file);
Result<std::unique_ptr<Network>> open_opencv_network(const std::filesystem::path& file);

static constexpr std::array kBackends{
    NetworkBackend{"onednn", open_onednn_network},
    NetworkBackend{"opencv", open_opencv_network},
};

std::span<const NetworkBackend> network_backends() { return kBackends; }

Result<std::unique_ptr<Network>> open_network(const std::string& backend,
                                              const std::filesystem::path& file) {
  std::string known;
  for (const NetworkBackend& entry : network_backends()) {
    if (backend == entry.name) return entry.open(file);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return fail(Errc::bad_config,
              fmt::format("networks: no back end '{}'; this build has: {}", backend, known));
}

}  // namespace handcast::landmarks
