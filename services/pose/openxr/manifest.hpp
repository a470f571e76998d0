// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::pose::openxr {

/// What the manifest of an OpenXR runtime says.
struct Manifest {
  std::string file;     ///< the manifest itself
  std::string name;     ///< of the runtime; that of its library if the manifest has none
  std::string library;  ///< a path, or a name that the system's linker finds
};

/// The places where the loader looks for the active runtime, in its order: XR_RUNTIME_JSON, the
/// user's configuration, the system's.
std::vector<std::string> active_runtime_places();

/// The manifest in `chosen`, or, if that is empty, in the first of active_runtime_places() that
/// exists. The runtime is not started. Errors: unavailable (no such file; the library is missing),
/// bad_config (not a manifest, or not readable).
Result<Manifest> find_runtime(const std::string& chosen);

/// Whether the library of a runtime can be loaded. It stays in the process, and is not started.
/// Errors: unavailable (it cannot be).
Result<void> check_library(const Manifest& runtime);

}  // namespace handcast::pose::openxr
