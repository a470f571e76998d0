// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/present_backend.hpp"

#include <fmt/format.h>

#include "config/renamed_settings.hpp"
#include "config/settings/settings.hpp"

namespace handcast::supervisor {

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
