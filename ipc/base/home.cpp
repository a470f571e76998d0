// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/home.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "ipc/base/quote.hpp"

namespace handcast {
namespace {

/// "" if there is no such user.
std::string folder_of(const passwd* user) { return user && user->pw_dir ? user->pw_dir : ""; }

std::string own_folder() {
  if (const char* home = std::getenv("HOME"); home && *home != '\0') return home;
  std::array<char, 16384> texts;
  passwd entry{};
  passwd* found = nullptr;
  getpwuid_r(getuid(), &entry, texts.data(), texts.size(), &found);
  return folder_of(found);
}

std::string folder_of_user(const std::string& name) {
  std::array<char, 16384> texts;
  passwd entry{};
  passwd* found = nullptr;
  getpwnam_r(name.c_str(), &entry, texts.data(), texts.size(), &found);
  return folder_of(found);
}

}  // namespace

Result<std::string> expand_home(const std::string& path) {
  std::error_code unknown;
  if (!path.starts_with('~') || std::filesystem::exists(path, unknown)) return path;
  const auto slash = std::min(path.find('/'), path.size());
  const auto user = path.substr(1, slash - 1);
  const auto folder = user.empty() ? own_folder() : folder_of_user(user);
  if (!folder.empty()) return folder + path.substr(slash);
  return fail(Errc::bad_config,
              user.empty()
                  ? quote(path) + ": ~ is not known, because HOME is not set; write the whole path"
                  : fmt::format("{}: there is no user {}; ~/ is your own folder", quote(path),
                                quote(user)));
}

std::string odd_path(const std::string& path) {
  if (path.starts_with("file:"))
    return fmt::format("{} is an address; write the path alone, as in \"/home/you/a.png\"",
                       quote(path));
  if (path.starts_with('$') || path.starts_with('%'))
    return fmt::format("{}: variables are not replaced here; write ~/ or the whole path",
                       quote(path));
  if (path.size() > 2 && std::isalpha(static_cast<unsigned char>(path[0])) != 0 && path[1] == ':' &&
      (path[2] == '\\' || path[2] == '/'))
    return fmt::format(
        "{} is a path of Windows; this computer has no drives, and writes paths with "
        "/: \"/home/you/a.png\"",
        quote(path));
  return {};
}

std::string fault_of_path(const std::string& path, const std::filesystem::path& folder) {
  std::error_code unknown;
  if (path.starts_with('/') || std::filesystem::exists(folder / path, unknown)) return {};
  if (std::ranges::any_of(path, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    return quote(path) +
           " is not a path: in double quotes, \\n, \\t and the like are escapes; write single ones";
  return odd_path(path);
}

Result<std::filesystem::path> state_folder() {
  std::filesystem::path base;
  for (const char* name : {"STATE_DIRECTORY", "XDG_STATE_HOME"})
    if (const char* value = std::getenv(name); value && *value == '/' && base.empty()) base = value;
  if (base.empty()) {
    const auto home = expand_home("~/.local/state");
    if (!home) return fail(Errc::unavailable, home.error().what);
    base = *home;
  }
  std::error_code failed;
  std::filesystem::create_directories(base / "handcast", failed);
  if (failed)
    return fail(Errc::unavailable, fmt::format("the folder {} cannot be made: {}",
                                               (base / "handcast").string(), failed.message()));
  return base / "handcast";
}

}  // namespace handcast
