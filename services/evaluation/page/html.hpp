// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace handcast::page {

/// Text as it may stand in HTML, in an attribute too.
std::string escape(std::string_view text);

/// A skeleton with every {{name}} replaced by its value. A name without a value becomes nothing.
/// Values are not looked into.
std::string fill(std::string_view skeleton,
                 const std::map<std::string, std::string, std::less<>>& values);

std::string base64(std::span<const unsigned char> bytes);

/// A figure with `digits` decimals; a dash where there is none.
std::string figure(std::optional<double> value, int digits);

/// A paragraph that says what a section lacks.
std::string missing(std::string_view sentence);

}  // namespace handcast::page
