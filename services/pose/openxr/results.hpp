// SPDX-License-Identifier: Apache-2.0
// Only for the files that call the loader.
#pragma once
#include <openxr/openxr.h>

#include <cstring>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::pose::openxr {

/// The reaction to a result that is an error.
Errc code_of(XrResult result);
/// The name of a result: "XR_ERROR_SESSION_LOST".
std::string word_of(XrResult result);

/// A text of the runtime, which need not end with a zero byte.
template <std::size_t kSize>
std::string text_of(const char (&text)[kSize]) {
  return {text, strnlen(text, kSize)};
}

}  // namespace handcast::pose::openxr
