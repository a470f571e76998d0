// SPDX-License-Identifier: Apache-2.0
// A request to the exporter, as it arrives byte by byte, and the answer to it.
// Limits: 10 s and 1 GB per input.
#include "supervisor/look/metrics/http_server.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  constexpr std::size_t kMostParts = 64;
  const auto whole = fuzz::text_of({data, size});
  const std::size_t step = std::max<std::size_t>(1, size / kMostParts);
  for (std::size_t arrived = 0; arrived <= size; arrived += step) {
    const auto request = supervisor::parse_http_request(whole.substr(0, arrived));
    if (!request) continue;
    const auto answer = supervisor::http_answer(*request, [] { return std::string("figures"); });
    fuzz::require(answer.starts_with("HTTP/1.1 ") && answer.find("\r\n\r\n") != answer.npos);
  }
  return 0;
}
