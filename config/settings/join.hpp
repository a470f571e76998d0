// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::config {

/// The texts in a row with `separator` between them. (fmt::join of fmt 9 draws a false overflow
/// warning from g++ 12.)
template <class Texts>
std::string join(const Texts& texts, std::string_view separator) {
  std::string joined;
  for (const auto& text : texts) {
    if (&text != &*texts.begin()) joined += separator;
    joined += text;
  }
  return joined;
}

}  // namespace handcast::config
