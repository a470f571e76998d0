// SPDX-License-Identifier: Apache-2.0
// The figures that the exporter serves, from the status of a supervisor.
// Limits: 10 s and 1 GB per input.
#include "supervisor/look/metrics/metrics.hpp"

#include <nlohmann/json.hpp>

#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  supervisor::RigLook look{.rig = "fuzz", .taken_ns = 1};
  look.figures = supervisor::figures_in(nlohmann::json::parse(data, data + size, nullptr, false));
  fuzz::require(!supervisor::metrics_text(look).empty());
  return 0;
}
