// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/back_end_files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "ipc/base/program.hpp"

namespace handcast::daemon {
namespace fs = std::filesystem;

std::map<std::string, fs::path, std::less<>> back_end_files(std::string_view service) {
  if (service.ends_with('2')) service.remove_suffix(1);
  std::error_code absent;
  const char* const more = ::secure_getenv("LD_LIBRARY_PATH");
  std::istringstream places((program_folder().parent_path() / "lib").string() + ":" +
                            (more ? more : ""));
  std::map<std::string, fs::path, std::less<>> files;
  for (std::string place; std::getline(places, place, ':');)
    for (const auto& entry : fs::directory_iterator(fs::path(place) / "handcast" / service, absent))
      if (place.starts_with('/') && entry.path().extension() == ".so")
        files.emplace(entry.path().stem().string(), entry.path());
  return files;
}

static std::string print(const Abi& abi) { return fmt::format("{}-{}", abi.version, abi.bytes); }

Result<const void*> load_back_end(std::string_view service, std::string_view name, const Abi& abi) {
  const auto files = back_end_files(service);
  const auto found = files.find(name);
  if (found == files.end()) return nullptr;
  const auto& file = found->second;
  const auto refuse = [&](const std::string& why) {
    return fail(Errc::bad_config, fmt::format("{} {}", file.string(), why));
  };
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return refuse(fmt::format("cannot be loaded: {}", ::dlerror()));
  const auto symbol = fmt::format("handcast_{}_back_end", file.parent_path().filename().string());
  const void* const object = ::dlsym(library, symbol.c_str());
  if (!object) return refuse("is no back end of this service: it lacks " + symbol);
  const auto theirs = print(*static_cast<const Abi*>(object)), ours = print(abi);
  if (theirs == ours) return object;
  return refuse(
      fmt::format("was built for handcast {}, and this is {}; build it again", theirs, ours));
}

}  // namespace handcast::daemon
