// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/second_view.hpp"

namespace handcast::service {

std::string of_second_view(std::string_view name) {
  for (const std::string_view section : {"camera", "landmarks"})
    if (name == section ||
        (name.starts_with(section) && name.substr(section.size()).starts_with('.')))
      return std::string(section) + "2" + std::string(name.substr(section.size()));
  return std::string(name);
}

daemon::ServiceDescription of_second_view(daemon::ServiceDescription description) {
  const auto rename = [](std::vector<std::string>& names) {
    for (auto& name : names) name = of_second_view(name);
  };
  description.is_second_view = true;
  description.name = of_second_view(description.name);
  description.summary = "Of the second camera: " + description.summary;
  description.paced_by = of_second_view(description.paced_by);
  rename(description.publishes);
  rename(description.subscribes);
  rename(description.settings);
  for (auto& backend : description.backends) rename(backend.settings);
  return description;
}

}  // namespace handcast::service
