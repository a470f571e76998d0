// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "config/settings/setting_list.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/result.hpp"
#include "ipc/daemon/attached.hpp"
#include "ipc/daemon/back_end_files.hpp"
#include "ipc/daemon/description.hpp"

namespace handcast::service {

/// One row of a table of back ends: all that is known of a back end outside its own file.
/// `--backends`, the settings reference, what a reload restarts and how a standby starts follow
/// from it. `Interface`: the seam (a camera, a pose source, …). `Args`: what every back end of the
/// seam is opened with.
template <class Interface, class... Args>
struct Backend {
  std::string_view name;      ///< in the rig file
  std::string_view sentence;  ///< what it is, for people
  /// Opens it. Errors: bad_config, unavailable, disconnected.
  Result<std::unique_ptr<Interface>> (*open)(const Args&...);
  /// The sections and settings it reads, besides those that its service reads with every back end.
  /// A reload restarts the service if one of them changes.
  config::SettingList reads{};
  /// Only one process at a time can have it open (a device): a standby opens it in its turn.
  bool exclusive = false;
  /// What `config --check` does instead of open(): it looks at the files that the back end needs
  /// and leaves devices and services alone, which a running rig may use. Errors: those of open()
  /// that a person must change. Null: it opens the back end, unless that is exclusive.
  Result<void> (*check)(const Args&...) = nullptr;
  /// Of a file: the devices that are attached and that it opens. Null: it does not look for any.
  std::vector<daemon::Attached> (*attached)(const daemon::Search&) = nullptr;

  /// Checks it: calls `check`, or else opens it, unless it is exclusive. Errors: theirs.
  Result<void> examine(const Args&... args) const {
    if (check) return check(args...);
    if (exclusive) return {};
    const auto opened = open(args...);
    return opened ? Result<void>() : tl::make_unexpected(opened.error());
  }
};

/// Backend::check of what is seen only when the rig is up: whether a program sends.
inline constexpr auto kSeenWhenUp = [](const auto&...) -> Result<void> { return {}; };

inline constexpr daemon::Abi kAbi{"0.1.0-2", sizeof(config::Rig) + sizeof(calib::Calibration)};

/// What the file of a back end exports, under the name that its seam declares. It calls the
/// functions of the program.
template <class Row>
struct LoadedBackEnd {
  daemon::Abi abi = kAbi;
  Row row;
};

/// The row that the file of a back end exports; null if there is no such file. Errors: those of
/// daemon::load_back_end().
template <class Row>
Result<const Row*> load_row(std::string_view service, std::string_view name) {
  return daemon::load_back_end(service, name, kAbi).map([](const void* object) {
    return object ? &static_cast<const LoadedBackEnd<Row>*>(object)->row : nullptr;
  });
}

/// The devices that the back ends of a service find which are files of their own. A file that
/// cannot be loaded is a device with this trouble, and without names.
template <class Row>
std::vector<daemon::Attached> attached_of_files(std::string_view service,
                                                const daemon::Search& search) {
  std::vector<daemon::Attached> all;
  for (const auto& [name, file] : daemon::back_end_files(service)) {
    const auto row = load_row<Row>(service, name);
    if (!row)
      all.push_back({.name = fmt::format("{} '{}'", service, name),
                     .settings = {{fmt::format("{}.backend", service), name}},
                     .trouble = row.error().what});
    if (!row || !*row || !(*row)->attached) continue;
    for (auto& device : (*row)->attached(search)) all.push_back(std::move(device));
  }
  return all;
}

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

/// The back end called `name`: of the table, or else that of a file. Errors: bad_config with the
/// known names if there is none of this name, those of load_row().
template <class Interface, class... Args>
Result<Backend<Interface, Args...>> find_backend(
    std::string_view what, std::string_view name,
    std::span<const Backend<Interface, Args...>> table) {
  for (const auto& row : table)
    if (row.name == name) return row;
  const auto loaded = load_row<Backend<Interface, Args...>>(what, name);
  if (!loaded) return fail_in(what, loaded.error());
  if (*loaded) return **loaded;
  return fail(Errc::bad_config, fmt::format("{}: no back end '{}'; this build has: {}", what, name,
                                            join(names_of(table), ", ")));
}

/// Opens the back end called `name`. Errors: those of find_backend() and of the back end.
template <class Interface, class... Args>
Result<std::unique_ptr<Interface>> open_backend(std::string_view what, std::string_view name,
                                                std::span<const Backend<Interface, Args...>> table,
                                                const Args&... args) {
  const auto row = find_backend(what, name, table);
  if (!row) return tl::make_unexpected(row.error());
  return row->open(args...);
}

/// Checks the back end called `name`. Errors: those of find_backend() and of Backend::examine().
template <class Interface, class... Args>
Result<void> check_backend(std::string_view what, std::string_view name,
                           std::span<const Backend<Interface, Args...>> table,
                           const Args&... args) {
  const auto row = find_backend(what, name, table);
  return row ? row->examine(args...) : tl::make_unexpected(row.error());
}

/// Passes on what a back end returned, an error with its service and its name before the sentence:
/// "camera2 'v4l2': no camera is attached".
template <class T>
Result<T> in_backend(std::string_view service, std::string_view backend, Result<T> result) {
  if (result) return result;
  return fail_in(fmt::format("{} '{}'", service, backend), std::move(result.error()));
}

/// Whether a standby must not open this back end before its turn.
template <class Interface, class... Args>
bool is_exclusive(std::string_view what, std::string_view name,
                  std::span<const Backend<Interface, Args...>> table) {
  const auto row = find_backend(what, name, table);
  return row && row->exclusive;
}

}  // namespace handcast::service
