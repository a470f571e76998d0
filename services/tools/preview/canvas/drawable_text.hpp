// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::preview {

/// The text with '?' for all that is not UTF-8, control characters, and characters of four bytes:
/// one bad byte would end all drawing with cairo.
std::string drawable(std::string_view text);

}  // namespace handcast::preview
