// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "services/tools/preview/layout/layout.hpp"

namespace handcast::preview {

/// What a key asks for, apart from another look.
enum class Wish { nothing, quit, shot };

/// Obeys a key: a character, or "Escape". 1 to 6 switch the layers, space freezes, h shows the
/// keys, s asks for a picture, q and Escape end. All others do nothing.
Wish obey(std::string_view key, Look& look);

}  // namespace handcast::preview
