// SPDX-License-Identifier: Apache-2.0
// A bring-up sequence. Limits: 10 s and 1 GB per input.
#include "services/camera/leap/bring_up.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  const auto steps = camera::leap::parse_bring_up(fuzz::text_of({data, size}), "file");
  if (!steps) {
    fuzz::require(steps.error().what.starts_with("file:"));
    return 0;
  }
  int line = 0;
  for (const auto& step : *steps) {
    fuzz::require(step.line > line && step.pause_ns >= 0);
    fuzz::require(step.transfer.reads() || step.transfer.data.size() == step.transfer.length);
    line = step.line;
  }
  return 0;
}
