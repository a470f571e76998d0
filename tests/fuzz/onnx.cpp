// SPDX-License-Identifier: Apache-2.0
// An ONNX file: its structure, then the network that oneDNN makes of it.
// Limits: 10 s and 1 GB per input.
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/inference/onnx/model.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  using namespace handcast::landmarks;
  const auto model = onnx::parse_model({data, size});
  if (!model) return 0;
  static fuzz::MemoryFile file;
  file.write({data, size});
  const auto network = open_network(file.path());
  if (!network) return 0;
  for (std::size_t i = 0; i < (*network)->inputs().size(); ++i)
    std::ranges::fill((*network)->input(i), 0.5f);
  (void)(*network)->run();
  return 0;
}
