// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast {

/// Joins texts with `separator` between them. fmt::join of fmt 9 is not used because g++ 12 reports
/// a false overflow in it.
template <class Texts>
std::string join(const Texts& texts, std::string_view separator) {
  std::string joined;
  for (const auto& text : texts) {
    if (&text != &*texts.begin()) joined += separator;
    joined += text;
  }
  return joined;
}

}  // namespace handcast
