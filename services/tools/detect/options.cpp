// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/options.hpp"

#include <fmt/format.h>

#include "config/renamed_settings.hpp"

namespace handcast::detect {

void set_backend(Options& options, const std::string& name) {
  const auto report = [](const std::string& sentence) { fmt::print(stderr, "{}\n", sentence); };
  for (const auto& [setting, value] : config::current_form(
           {"landmarks.backend", name}, "handcast detect", config::renamed_settings(), report))
    if (setting == "landmarks.backend") options.backend = value;
}

}  // namespace handcast::detect
