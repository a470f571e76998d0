// SPDX-License-Identifier: Apache-2.0
// A NumPy array, also read as the time stamps of a sensor.
// Limits: 10 s and 1 GB per input.
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  static fuzz::MemoryFile file;
  file.write({data, size});
  if (const auto array = recording::read_npy(file.path())) {
    std::size_t count = 1;
    for (const auto extent : array->shape) count *= extent;
    fuzz::require(count == array->values.size());
  }
  if (const auto times_ns = recording::read_stamps_ns(file.path()))
    fuzz::require(std::is_sorted(times_ns->begin(), times_ns->end()));
  return 0;
}
