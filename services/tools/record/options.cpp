// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "ipc/base/command_line.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::record {
namespace {

constexpr double kLongest_s = 30 * 86'400.0;

/// Adds the parts of a list with commas.
CommandLine::Setter add_to(std::vector<std::string>& names) {
  return [&names](const std::string& list) -> Result<void> {
    std::istringstream parts(list);
    for (std::string name; std::getline(parts, name, ',');) names.push_back(name);
    return {};
  };
}

}  // namespace

Result<Parsed> parse(int argc, char** argv) {
  Parsed parsed;
  auto& options = parsed.options;
  CommandLine line(
      "handcast record",
      "Writes the rings of a running rig to a folder, until Ctrl-C or the end of the rig.");
  line.add("DIR", options.folder, "A new or empty folder");
  line.add("--rig NAME", options.rig, "Which rig, if several are up");
  line.add("--seconds N", options.seconds, "Stops after so many seconds", {0.1, kLongest_s});
  line.add("--rings LIST", add_to(options.rings),
           "What is recorded: all, or some of camera, pose, landmarks, projection, marks, or "
           "whole names of rings, separated by commas");
  line.add("--npy", options.npy,
           "Afterwards also writes DIR/npy: arrays in the layout of Casper DPM and PNG images");
  line.add("--convert", options.convert, "Records nothing: writes DIR/npy for the recording DIR");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  parsed.text = std::move(*text);
  if (options.rings == std::vector<std::string>{"all"}) options.rings.clear();
  return parsed;
}

Result<std::vector<std::string>> choose(const std::vector<std::string>& rings,
                                        const std::vector<std::string>& there) {
  const auto fits = [](const std::string& wish, const std::string& name) {
    return name == wish || name.starts_with(wish + ".");
  };
  for (const auto& wish : rings)
    if (std::ranges::none_of(there, [&](const auto& name) { return fits(wish, name); }))
      return fail(Errc::bad_config, fmt::format("--rings: the rig has no ring {}; it has: {}",
                                                quote(wish), join(there, ", ")));
  std::vector<std::string> chosen;
  for (const auto& name : there)
    if (rings.empty() ||
        std::ranges::any_of(rings, [&](const auto& wish) { return fits(wish, name); }))
      chosen.push_back(name);
  return chosen;
}

}  // namespace handcast::record
