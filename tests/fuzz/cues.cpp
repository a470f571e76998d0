// SPDX-License-Identifier: Apache-2.0
// A cue list. What is accepted has cues with names of their own, and targets that the panel takes.
// Limits: 10 s and 1 GB.
#include <string>

#include "services/desk/cues/cue_list.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/services/desk/table_panel.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  const std::string toml(fuzz::text_of({data, size}));
  test::TablePanel panel;
  const auto list = desk::cues::parse_cues(toml, "/fuzz/cues.toml", panel.controls());
  if (!list) {
    fuzz::require(!list.error().what.empty());
    return 0;
  }
  fuzz::require(!list->cues.empty());
  for (const auto& cue : list->cues)
    for (const auto& target : cue.targets)
      fuzz::require(target.numbers.empty() != target.assignment.empty() &&
                    target.control < panel.controls().size());
  return 0;
}
