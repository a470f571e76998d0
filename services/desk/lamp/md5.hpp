// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::desk::lamp {

/// The MD5 digest of a text (RFC 1321) in 32 hexadecimal digits. PJLink asks for it; it protects
/// nothing else.
std::string md5(std::string_view text);

}  // namespace handcast::desk::lamp
