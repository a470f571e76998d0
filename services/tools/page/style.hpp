// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::page {

/// The CSS shared by all pages: colours of the light and the dark colour scheme, text, tables.
extern const char* const kStyle;

}  // namespace handcast::page
