// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openxr/openxr.h>

#include <array>
#include <cstring>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::pose::openxr {

// Only for the files that call the loader.

/// The reaction to a result that is an error.
Errc code_of(XrResult result);
/// The name of a result: "XR_ERROR_SESSION_LOST".
std::string word_of(XrResult result);

/// A text of the runtime, which need not end with a zero byte.
template <std::size_t kSize>
std::string text_of(const char (&text)[kSize]) {
  return {text, strnlen(text, kSize)};
}

/// The extensions without which a runtime is of no use.
std::array<const char*, 3> needed_extensions();

/// Loads the active runtime and looks whether it has them. `runtime`: its name, for people. Errors:
/// unavailable (it cannot be loaded), bad_config (it lacks one, and what that means).
Result<void> check_extensions(const std::string& runtime);

}  // namespace handcast::pose::openxr
