// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/canvas/drawable_text.hpp"

#include <algorithm>

namespace handcast::preview {
namespace {

/// Number of bytes of the UTF-8 character that begins with this byte; 0 if none does.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

}  // namespace

std::string drawable(std::string_view text) {
  std::string good;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const auto length = length_of(first);
    const auto rest = text.substr(i + 1, length > 0 ? length - 1 : 0);
    // Three and four bytes: overlong forms and surrogates are not distinguished, so all but the
    // common planes are left out.
    const bool is_common =
        length < 4 &&
        (first != 0xe0 || (!rest.empty() && static_cast<unsigned char>(rest[0]) >= 0xa0)) &&
        first != 0xed;
    const bool is_good = length > 0 && is_common && rest.size() == length - 1 &&
                         std::ranges::all_of(rest, continues) && first >= 0x20 && first != 0x7f;
    good += is_good ? std::string(text.substr(i, length)) : "?";
    i += is_good ? length : 1;
  }
  return good;
}

}  // namespace handcast::preview
