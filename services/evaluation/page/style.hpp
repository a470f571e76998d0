// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::page {

/// CSS that every page of the house begins with: colours (for dark rooms too), text, tables.
extern const char* const kStyle;

}  // namespace handcast::page
