// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::page {

/// A self-contained HTML page.
struct Document {
  std::string title;   ///< plain text
  std::string style;   ///< CSS that follows kStyle
  std::string facts;   ///< HTML of fact(), shown below the title
  std::string header;  ///< HTML below the facts
  std::string body;    ///< HTML of the sections
};

/// The page as the content of an HTML file.
std::string to_html(const Document& document);

/// The HTML of one named value of the header; "" if the value is empty. Escapes both.
std::string fact(std::string_view name, std::string_view value);

}  // namespace handcast::page
