// SPDX-License-Identifier: Apache-2.0
// A line that a program sends to the control socket, and a description of a service.
// Limits: 10 s and 1 GB per input.
#include "ipc/control/control_message.hpp"
#include "ipc/daemon/description.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  const auto text = fuzz::text_of({data, size});
  if (const auto request = control::parse_request(text)) {
    const auto printed = control::print_request(*request);
    const auto again = control::parse_request(printed);
    fuzz::require(again && control::print_request(*again) == printed);
  } else {
    control::to_line(control::failure(request.error().what));
  }
  if (const auto description = daemon::parse_description(text)) {
    daemon::print_backends(*description);
    fuzz::require(daemon::parse_description(daemon::print_description(*description)).has_value());
  }
  return 0;
}
