// SPDX-License-Identifier: Apache-2.0
// A rig file: TOML up to the first zero byte, then one argument of --set per line.
// Limits: 10 s and 1 GB per input.
#include "config/rig.hpp"

#include "config/measured.hpp"
#include "tests/fuzz/input.hpp"

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  const auto text = fuzz::text_of({data, size});
  const auto end = std::min(text.find('\0'), size);
  const auto settings = lines_of(text.substr(std::min(end + 1, size)));
  const auto measured = config::parse_measured(std::string(text.substr(0, end)), "rig");
  if (measured)
    fuzz::require(config::parse_measured(config::print_measured(*measured), "rig").has_value());
  const auto rig = config::parse_rig(std::string(text.substr(0, end)), "/rigs/rig.toml", settings);
  if (!rig) {
    fuzz::require(rig.error().code == Errc::bad_config && !rig.error().what.empty());
    return 0;
  }
  // A rig that was read is the same after it was printed and read again.
  const auto printed = config::print_rig(*rig);
  const auto again = config::parse_rig(printed, "/rigs/rig.toml");
  fuzz::require(again && config::print_rig(*again) == printed);
  return 0;
}
