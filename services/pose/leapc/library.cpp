// SPDX-License-Identifier: Apache-2.0
#include "services/pose/leapc/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "ipc/base/join.hpp"

namespace handcast::pose::leapc {

// The kernel copies and checks the address on the way. Where a sandbox forbids the call, the
// pointer is trusted.
bool copy_memory(const void* from, void* to, std::size_t bytes) {
  if (!from) return false;
  const iovec here{to, bytes};
  const iovec there{const_cast<void*>(from), bytes};
  const ssize_t copied = ::process_vm_readv(::getpid(), &here, 1, &there, 1, 0);
  if (copied == static_cast<ssize_t>(bytes)) return true;
  if (copied >= 0 || (errno != EPERM && errno != ENOSYS)) return false;
  std::memcpy(to, from, bytes);
  return true;
}

namespace {

constexpr std::int32_t kOldest = 5;

std::string last_error() {
  const char* text = ::dlerror();
  return text ? text : "unknown error";
}

Result<void*> load(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown))
    return fail(Errc::bad_config, fmt::format("{}: there is no such file", path));
  // A pipe would be waited for.
  if (!std::filesystem::is_regular_file(path, unknown))
    return fail(Errc::bad_config, fmt::format("{}: this is not a file", path));
  if (void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  return fail(Errc::bad_config,
              fmt::format("{}: this library cannot be loaded: {}", path, last_error()));
}

/// The first library that is there; `path` gets its name.
Result<void*> search(std::string& path) {
  for (const auto place : kLibraryPlaces) {
    path = place;
    if (place.front() == '/') {
      if (std::error_code unknown; std::filesystem::exists(place, unknown)) return load(path);
    } else if (void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
      return handle;
    }
  }
  return fail(Errc::bad_config, "Ultraleap's library is not installed; " + std::string(kRemedy));
}

/// Looks up functions and remembers the names of those that are missing.
class Symbols {
 public:
  explicit Symbols(void* handle) : handle_(handle) {}

  template <class Function>
  void find(const char* name, Function*& function) {
    find_if_there(name, function);
    if (!function) missing_.emplace_back(name);
  }
  template <class Function>
  void find_if_there(const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(::dlsym(handle_, name));
  }
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  void* handle_;
  std::vector<std::string> missing_;
};

std::vector<std::string> find_functions(void* handle, Functions& call) {
  Symbols symbols(handle);
  symbols.find("LeapGetNow", call.now_us);
  symbols.find("LeapCreateConnection", call.create_connection);
  symbols.find("LeapOpenConnection", call.open_connection);
  symbols.find("LeapPollConnection", call.poll);
  symbols.find("LeapCloseConnection", call.close_connection);
  symbols.find("LeapDestroyConnection", call.destroy_connection);
  symbols.find("LeapSetPolicyFlags", call.set_policies);
  symbols.find("LeapSetTrackingMode", call.set_mode);
  symbols.find("LeapOpenDevice", call.open_device);
  symbols.find("LeapCloseDevice", call.close_device);
  symbols.find("LeapGetDeviceInfo", call.device_info);
  symbols.find("LeapCreateClockRebaser", call.create_rebaser);
  symbols.find("LeapUpdateRebase", call.update_rebaser);
  symbols.find("LeapRebaseClock", call.rebase);
  symbols.find("LeapDestroyClockRebaser", call.destroy_rebaser);
  symbols.find_if_there("LeapGetVersion", call.version);
  symbols.find_if_there("LeapSubscribeEvents", call.subscribe);
  return symbols.missing();
}

}  // namespace

Result<Library> open_library(const std::string& path) {
  Library library{.path = path};
  const auto handle = path.empty() ? search(library.path) : load(path);
  if (!handle) return tl::make_unexpected(handle.error());
  if (const auto missing = find_functions(*handle, library.call); !missing.empty())
    return fail(Errc::bad_config,
                fmt::format("{}: this is not the LeapC library of version {} or later; it lacks {}",
                            library.path, kOldest, join(missing, ", ")));
  Version version{};
  if (!library.call.version || library.call.version(nullptr, 0, &version) != kSuccess)
    return library;
  library.version = fmt::format("{}.{}.{}", version.major, version.minor, version.patch);
  if (version.major >= kOldest) return library;
  return fail(Errc::bad_config,
              fmt::format("{}: this is version {} of the library; version {} or later is needed, "
                          "which comes with Ultraleap's hand tracking software",
                          library.path, library.version, kOldest));
}

}  // namespace handcast::pose::leapc
