// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/known_backends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "config/settings/join.hpp"
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
                                            config::join(known, ", ")));
}

}  // namespace handcast::supervisor
