// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/layout/layer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/join.hpp"

namespace handcast::preview {

Layers default_layers() {
  return Layers()
      .set(static_cast<std::size_t>(Layer::image))
      .set(static_cast<std::size_t>(Layer::light));
}

Result<Layers> parse_layers(std::string_view text) {
  if (text == "all") return Layers().set();
  Layers layers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(',', begin), text.size());
    const auto name = text.substr(begin, end - begin);
    const auto found = std::ranges::find(kLayerNames, name);
    if (found == kLayerNames.end())
      return fail(Errc::bad_config, fmt::format("there is no layer '{}'; there are: {}, and all",
                                                name, join(kLayerNames, ", ")));
    layers.set(static_cast<std::size_t>(found - kLayerNames.begin()));
    begin = end + 1;
  }
  return layers;
}

}  // namespace handcast::preview
