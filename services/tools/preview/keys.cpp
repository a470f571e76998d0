// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/keys.hpp"

namespace handcast::preview {

Wish obey(std::string_view key, Look& look) {
  if (key == "q" || key == "Escape") return Wish::quit;
  if (key == "s") return Wish::shot;
  if (key == "h") look.help = !look.help;
  if (key == " ") look.frozen = !look.frozen;
  if (key.size() == 1 && key[0] >= '1' && key[0] < '1' + static_cast<char>(kLayers))
    look.layers.flip(static_cast<std::size_t>(key[0] - '1'));
  return Wish::nothing;
}

}  // namespace handcast::preview
