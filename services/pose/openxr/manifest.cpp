// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/manifest.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace handcast::pose::openxr {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kActive = "openxr/1/active_runtime.json";
constexpr std::uintmax_t kLargest_bytes = 1'000'000;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string in(const fs::path& folder) { return folder / kActive; }

bool is_file(const std::string& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown);
}

/// The path of the library as the loader understands it: one with a slash is relative to the
/// manifest.
std::string library_of(const fs::path& manifest, const std::string& named) {
  if (named.find('/') == std::string::npos) return named;
  return (fs::absolute(manifest).parent_path() / named).lexically_normal();
}

Result<Manifest> read(const std::string& file) {
  std::error_code unknown;
  if (fs::file_size(file, unknown) > kLargest_bytes)
    return fail(Errc::bad_config, fmt::format("'{}' is too large for a manifest", file));
  std::ifstream stream(file);
  if (!stream)
    return fail(Errc::bad_config,
                fmt::format("the manifest of an OpenXR runtime '{}' cannot be read: {}", file,
                            std::strerror(errno)));
  const auto document = nlohmann::json::parse(stream, nullptr, false);
  // Not copied, because a copy follows the depth of the file by recursion.
  const nlohmann::json none;
  const auto inside = document.find("runtime");  // end() also if the document is no object
  const auto& runtime = inside == document.end() ? none : *inside;
  const auto text = [&runtime](const char* member) {
    const auto found = runtime.find(member);
    return found != runtime.end() && found->is_string() ? found->get<std::string>() : "";
  };
  if (!runtime.is_object() || text("library_path").empty())
    return fail(
        Errc::bad_config,
        fmt::format("'{}' is no manifest of an OpenXR runtime: it has no \"runtime\" with a "
                    "\"library_path\"",
                    file));
  Manifest manifest{file, text("name"), library_of(file, text("library_path"))};
  if (manifest.name.empty()) manifest.name = fs::path(manifest.library).filename();
  if (manifest.library.find('/') != std::string::npos && !is_file(manifest.library))
    return fail(Errc::unavailable,
                fmt::format("the library of the OpenXR runtime '{}' is missing: {} ({})",
                            manifest.name, manifest.library, file));
  return manifest;
}

}  // namespace

std::vector<std::string> active_runtime_places() {
  std::vector<std::string> places;
  if (auto chosen = variable("XR_RUNTIME_JSON"); !chosen.empty()) return {std::move(chosen)};
  if (const auto home = variable("XDG_CONFIG_HOME"); !home.empty())
    places.push_back(in(home));
  else if (const auto user = variable("HOME"); !user.empty())
    places.push_back(in(fs::path(user) / ".config"));
  auto folders = variable("XDG_CONFIG_DIRS");
  std::istringstream each(folders.empty() ? "/etc/xdg" : folders);
  for (std::string folder; std::getline(each, folder, ':');)
    if (!folder.empty()) places.push_back(in(folder));
  places.push_back(in("/etc"));
  return places;
}

Result<Manifest> find_runtime(const std::string& chosen) {
  if (!chosen.empty()) {
    if (is_file(chosen)) return read(chosen);
    return fail(Errc::unavailable,
                fmt::format("there is no manifest of an OpenXR runtime at '{}'", chosen));
  }
  if (const auto active = variable("XR_RUNTIME_JSON"); !active.empty() && !is_file(active))
    return fail(Errc::unavailable,
                fmt::format("there is no manifest of an OpenXR runtime at '{}' (XR_RUNTIME_JSON); "
                            "install the runtime, or clear this variable",
                            active));
  std::error_code unknown;
  for (const auto& place : active_runtime_places()) {
    if (is_file(place)) return read(place);
    if (fs::is_symlink(place, unknown))
      return fail(Errc::unavailable,
                  fmt::format("the active OpenXR runtime is gone: '{}' is a link to no file; "
                              "install the runtime, or make another one active",
                              place));
  }
  return fail(Errc::unavailable,
              "no OpenXR runtime is active on this computer; install one with hand tracking, e.g. "
              "Monado, and make it active, or name its manifest in pose.openxr.runtime");
}

Result<void> check_library(const Manifest& runtime) {
  if (::dlopen(runtime.library.c_str(), RTLD_LAZY | RTLD_LOCAL)) return {};
  const char* why = ::dlerror();
  return fail(Errc::unavailable,
              fmt::format("the library of the OpenXR runtime '{}' cannot be loaded: {} ({})",
                          runtime.name, why ? why : "unknown error", runtime.file));
}

}  // namespace handcast::pose::openxr
