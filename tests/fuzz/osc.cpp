// SPDX-License-Identifier: Apache-2.0
// A datagram of OSC, taken twice: by itself, and out of the queue of bundles of the future. What is
// refused is counted, and what is taken is one of the panel's values. Limits: 10 s and 1 GB.
#include <vector>

#include "services/desk/osc/inbox.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/services/desk/table_panel.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  using namespace handcast::desk::osc;
  // In memory of its own, so that a byte too many is found.
  const std::vector<std::uint8_t> bytes(data, data + size);
  test::TablePanel panel;
  const Addresses addresses(panel.controls());
  desk::Complaints complaints("osc", [](const std::string&) {});
  Inbox inbox(addresses, complaints);
  const Instant now{1'000'000'000, 1'700'000'000'000'000'000};
  inbox.take_due(now);
  inbox.take(bytes, "fuzz", now);
  inbox.apply(panel, nullptr, now);
  inbox.take_due({INT64_MAX, INT64_MAX});
  inbox.apply(panel, nullptr, now);
  fuzz::require(!inbox.next_due_ns() && !inbox.has_work());
  for (std::size_t i = 0; i < panel.controls().size(); ++i)
    (void)write_value(panel.controls()[i], panel.values()->toml[i]);
  return 0;
}
