// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace handcast::page {

/// Escapes text for HTML, including the values of attributes.
std::string escape(std::string_view text);

/// Replaces each {{name}} of a skeleton by its value, or by "" without one. Values are inserted as
/// they are: a {{name}} in a value is not replaced.
std::string fill(std::string_view skeleton,
                 const std::map<std::string, std::string, std::less<>>& values);

/// Base64 with padding (RFC 4648).
std::string base64(std::span<const unsigned char> bytes);

/// Prints a number with `digits` decimals; a dash if it is missing or not finite.
std::string figure(std::optional<double> value, int digits);

/// A paragraph that explains why something is missing. Escapes the sentence.
std::string missing(std::string_view sentence);

}  // namespace handcast::page
