// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::page {

/// A page that needs nothing but itself. All but the title is HTML.
struct Document {
  std::string title;
  std::string style;   ///< CSS, after the house's
  std::string facts;   ///< of fact(), under the title
  std::string header;  ///< below them
  std::string body;
};

std::string to_html(const Document& document);

/// One named value of the header; nothing where the value is empty.
std::string fact(std::string_view name, std::string_view value);

}  // namespace handcast::page
