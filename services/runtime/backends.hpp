// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/setting_list.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/result.hpp"
#include "ipc/daemon/description.hpp"

namespace handcast::service {

/// One row of a table of back ends: all that is known of a back end outside its own file.
/// `--backends`, the settings reference, what a reload restarts and how a spare starts follow from
/// it. `Interface`: the seam (a camera, a pose source, …). `Args`: what every back end of the seam
/// is opened with.
template <class Interface, class... Args>
struct Backend {
  std::string_view name;      ///< in the rig file
  std::string_view sentence;  ///< what it is, for people
  /// Opens it. Errors: bad_config, unavailable, disconnected.
  Result<std::unique_ptr<Interface>> (*open)(const Args&...);
  /// The sections and settings it reads, besides those that its service reads with every back end.
  /// A reload restarts the service if one of them changes.
  config::SettingList reads{};
  /// Only one process at a time can have it open (a device): a spare opens it in its turn.
  bool exclusive = false;
  /// What `config --check` does instead of open(): it looks at the files that the back end needs
  /// and leaves devices and services alone, which a running rig may use. Errors: those of open()
  /// that a person must change. Null: it opens the back end, unless that is exclusive.
  Result<void> (*check)(const Args&...) = nullptr;
};

/// The rows of a table without their code, in its order.
template <class Row>
std::vector<daemon::BackendDescription> describe_rows(std::span<const Row> table) {
  std::vector<daemon::BackendDescription> rows;
  for (const Row& row : table) {
    const auto reads = row.reads.paths();
    rows.push_back({.name = std::string(row.name),
                    .sentence = std::string(row.sentence),
                    .settings = {reads.begin(), reads.end()},
                    .exclusive = row.exclusive});
  }
  return rows;
}

/// The names in a table, in its order.
template <class Row>
std::vector<std::string_view> names_of(std::span<const Row> table) {
  std::vector<std::string_view> names;
  for (const Row& row : table) names.push_back(row.name);
  return names;
}

/// Opens the back end called `name`. Errors: bad_config with the known names if there is none of
/// this name; those of the back end.
template <class Interface, class... Args>
Result<std::unique_ptr<Interface>> open_backend(std::string_view what, std::string_view name,
                                                std::span<const Backend<Interface, Args...>> table,
                                                const Args&... args) {
  for (const auto& row : table)
    if (row.name == name) return row.open(args...);
  return fail(Errc::bad_config, fmt::format("{}: no back end '{}'; this build has: {}", what, name,
                                            join(names_of(table), ", ")));
}

/// Checks the back end called `name`: see Backend::check. Errors: those of the check and of
/// open_backend().
template <class Interface, class... Args>
Result<void> check_backend(std::string_view what, std::string_view name,
                           std::span<const Backend<Interface, Args...>> table,
                           const Args&... args) {
  for (const auto& row : table)
    if (row.name == name && (row.check || row.exclusive))
      return row.check ? row.check(args...) : Result<void>();
  const auto opened = open_backend(what, name, table, args...);
  return opened ? Result<void>() : tl::make_unexpected(opened.error());
}

/// Whether a spare must not open this back end before its turn.
template <class Interface, class... Args>
bool is_exclusive(std::string_view name, std::span<const Backend<Interface, Args...>> table) {
  for (const auto& row : table)
    if (row.name == name) return row.exclusive;
  return false;
}

}  // namespace handcast::service
