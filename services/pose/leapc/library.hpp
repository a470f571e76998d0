// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"
#include "services/pose/leapc/declarations.hpp"

namespace handcast::pose::leapc {

/// Copies memory of this process that another library points to. Returns false, instead of ending
/// the process, if it is not readable. Any thread.
bool copy_memory(const void* from, void* to, std::size_t bytes);

/// The same for one structure.
template <class T>
bool copy_memory(const T* from, T& to) {
  return copy_memory(from, &to, sizeof to);
}

/// Ultraleap's library in this process.
struct Library {
  std::string path;
  std::string version;  ///< e.g. "5.17.1"; empty: older than 5.2
  Functions call{};
};

/// Where the library is searched, in this order; a name without a folder is left to the linker.
inline constexpr std::array<std::string_view, 7> kLibraryPlaces{
    "/usr/lib/ultraleap-hand-tracking-service/libLeapC.so.6",
    "/usr/lib/ultraleap-hand-tracking-service/libLeapC.so.5",
    "/usr/lib/ultraleap-hand-tracking-service/libLeapC.so",
    "/opt/ultraleap/LeapSDK/lib/x64/libLeapC.so",
    "libLeapC.so.6",
    "libLeapC.so.5",
    "libLeapC.so"};

/// What to do if it is in none of these places.
inline constexpr std::string_view kRemedy =
    "install Ultraleap's hand tracking service (Gemini or later), or name libLeapC.so in "
    "pose.leapc.library";

/// Opens the library at `path`; empty: where Ultraleap's installers put it, and where the linker
/// finds it. It stays in the process for good, because it has threads of its own. Errors
/// (bad_config): it is not there (with kRemedy), it cannot be loaded, a function is missing, or it
/// is older than version 5.
Result<Library> open_library(const std::string& path);

}  // namespace handcast::pose::leapc
