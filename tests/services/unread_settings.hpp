// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "tests/config/every_setting.hpp"
#include "tests/supervisor/spec/built_catalogue.hpp"

namespace handcast::test {

/// The rig with another value in every setting that neither this row of the back ends of `service`
/// nor the service's own description names. What the back end delivers must not depend on them.
template <class Row>
config::Rig with_unread_settings_changed(config::Rig rig, const std::string& service,
                                         const Row& row) {
  auto read = built_catalogue().at(service).settings;
  const auto of_row = row.reads.paths();
  read.insert(read.end(), of_row.begin(), of_row.end());
  for (const auto& setting : config::every_setting(rig)) {
    const bool is_read = std::ranges::any_of(read, [&](const std::string& path) {
      return setting.path == path || setting.path.starts_with(path + ".");
    });
    if (!is_read) config::change(setting);
  }
  return rig;
}

}  // namespace handcast::test
