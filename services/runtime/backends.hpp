// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/join.hpp"
#include "ipc/base/result.hpp"

namespace handcast::service {

/// One line of a table of back ends: its name and how it is opened. `Interface` is the seam (a
/// camera, a pose source, …), `Args` what every back end of the seam is opened with.
template <class Interface, class... Args>
struct Backend {
  std::string_view name;
  Result<std::unique_ptr<Interface>> (*open)(const Args&...);
  bool exclusive = false;  ///< only one process at a time may have it open (a device): a spare
                           ///< opens it in its turn
};

template <class Entry>
std::vector<std::string_view> names_of(std::span<const Entry> table) {
  std::vector<std::string_view> names;
  for (const auto& entry : table) names.push_back(entry.name);
  return names;
}

/// Opens the back end called `name`. An unknown name is bad_config, with the known ones in the
/// sentence.
template <class Interface, class... Args>
Result<std::unique_ptr<Interface>> open_backend(std::string_view what, std::string_view name,
                                                std::span<const Backend<Interface, Args...>> table,
                                                const Args&... args) {
  for (const auto& entry : table)
    if (entry.name == name) return entry.open(args...);
  return fail(Errc::bad_config, fmt::format("{}: no back end '{}'; this build has: {}", what, name,
                                            config::join(names_of(table), ", ")));
}

/// Whether a spare must not open this back end before its turn.
template <class Interface, class... Args>
bool is_exclusive(std::string_view name, std::span<const Backend<Interface, Args...>> table) {
  for (const auto& entry : table)
    if (entry.name == name) return entry.exclusive;
  return false;
}

}  // namespace handcast::service
