// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/join.hpp"
#include "ipc/base/verb_options.hpp"

namespace handcast::record {
namespace {

constexpr double kLongest_s = 30 * 86'400.0;

}  // namespace

Result<Parsed> parse(int argc, char** argv) {
  Parsed parsed;
  auto& options = parsed.options;
  CLI::App app("Writes the rings of a running rig to a folder, until Ctrl-C or the end of the rig.",
               "handcast record");
  app.add_option("DIR", options.folder, "A new or empty folder")->required();
  app.add_option("--rig", options.rig, "Which rig, if several are up");
  app.add_option("--seconds", options.seconds, "Stops after so many seconds")
      ->check(CLI::Range(0.1, kLongest_s));
  app.add_option("--rings", options.rings,
                 "What is recorded: all, or some of camera, pose, landmarks, projection, marks, or "
                 "whole names of rings, separated by commas")
      ->delimiter(',');
  app.add_flag("--npy", options.npy,
               "Afterwards also writes DIR/npy: arrays in the layout of Casper DPM and PNG images");
  app.add_flag("--convert", options.convert,
               "Records nothing: writes DIR/npy for the recording DIR");
  auto text = parse_options(app, argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  parsed.text = std::move(*text);
  if (!std::isfinite(options.seconds)) return fail(Errc::bad_config, "--seconds: nan is no number");
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
      return fail(Errc::bad_config, fmt::format("--rings: the rig has no ring '{}'; it has: {}",
                                                wish, join(there, ", ")));
  std::vector<std::string> chosen;
  for (const auto& name : there)
    if (rings.empty() ||
        std::ranges::any_of(rings, [&](const auto& wish) { return fits(wish, name); }))
      chosen.push_back(name);
  return chosen;
}

}  // namespace handcast::record
