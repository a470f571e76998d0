// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"

namespace handcast::daemon {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BackendDescription, name, sentence, settings, exclusive)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ServiceDescription, name, summary, paced_by, publishes,
                                   subscribes, settings, backends)

std::string print_description(const ServiceDescription& description) {
  return nlohmann::json(description).dump(2) + "\n";
}

Result<ServiceDescription> parse_description(std::string_view json) try {
  return nlohmann::json::parse(json).get<ServiceDescription>();
} catch (const nlohmann::json::exception& problem) {
  return fail(Errc::bad_data,
              fmt::format("not a description of a service: {}", shown_line(problem.what(), 200)));
}

std::string print_backends(const ServiceDescription& description) {
  std::size_t width = 0;
  for (const auto& backend : description.backends) width = std::max(width, backend.name.size());
  std::string table;
  for (const auto& backend : description.backends)
    table += fmt::format("{:{}}  {}\n", backend.name, width, backend.sentence);
  return table;
}

}  // namespace handcast::daemon
