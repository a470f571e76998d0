// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/known_backends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "config/renamed_settings.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"
#include "supervisor/life/child.hpp"

namespace handcast::supervisor {
namespace {

constexpr int kLimit_ms = 3000;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

Result<void> check_backend(const std::filesystem::path& program_folder, const std::string& service,
                           const std::string& backend) {
  const auto output =
      output_of(program_folder / ("handcast-" + service), {"--backends"}, kLimit_ms);
  if (!output) return tl::make_unexpected(output.error());
  const auto known = lines_of(*output);
  if (known.empty()) return fail(Errc::bad_config, service + " has no back ends to choose from");
  if (std::ranges::find(known, backend) != known.end()) return {};
  return fail(Errc::bad_config, fmt::format("{} has no back end '{}'; it has: {}", service, backend,
                                            join(known, ", ")));
}

Result<std::string> present_backend(const std::string& service, const std::string& word,
                                    config::Rig rig) {
  std::string sentence;
  const auto report = [&](const std::string& renamed) { sentence = renamed; };
  const auto present = config::current_form({service + ".backend", word}, "swap",
                                            config::renamed_settings(), report);
  const auto listing = config::list_settings(rig);
  for (std::size_t i = 1; i < present.size(); ++i) {
    const auto has = config::print_value(*config::find_setting(listing, present[i].setting));
    if (has != fmt::format("\"{}\"", present[i].value))
      return fail(Errc::bad_config,
                  fmt::format("{}, but the rig has {} = {}: change the rig file and use "
                              "`handcast reload`",
                              sentence, present[i].setting, has));
  }
  return present.front().value;
}

}  // namespace handcast::supervisor
