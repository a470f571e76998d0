// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast::page {

/// The CSS of all pages, scripts/pages/templates/page.css: colours of the light and the dark colour
/// scheme, text, tables.
extern const std::string_view kStyle;

}  // namespace handcast::page
