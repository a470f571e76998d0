// SPDX-License-Identifier: Apache-2.0
// The report of a day that the night watch kept. What is accepted is written and read again as it
// is, and has a text and a page. Limits: 10 s and 1 GB.
#include "services/watch/day.hpp"

#include "services/watch/report.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  const auto day = watch::day_in(std::string(fuzz::text_of({data, size})));
  if (!day) {
    fuzz::require(!day.error().what.empty());
    return 0;
  }
  const auto written = watch::to_json(*day);
  const auto again = watch::day_in(written);
  fuzz::require(again && watch::to_json(*again) == written);
  fuzz::require(!watch::report_text(*day).empty());
  fuzz::require(watch::report_page(*day).ends_with("</html>\n"));
  return 0;
}
