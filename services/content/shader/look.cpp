// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "services/content/looks_folder.hpp"
#include "services/content/source.hpp"

namespace handcast::content {

Result<std::unique_ptr<Source>> open_isf(const Opening& opening);

Result<std::unique_ptr<Source>> open_look(const Opening& opening) {
  const auto names = look_names();
  const auto& name = opening.element.what;
  if (std::ranges::find(names, name) == names.end()) {
    const std::vector<std::string_view> all(names.begin(), names.end());
    return fail(Errc::bad_config, fmt::format("there is no look {}{}; there are: {}", quote(name),
                                              suggest(name, all), join(names, ", ")));
  }
  Opening file = opening;
  file.element.what = (looks_folder() / (name + ".fs")).string();
  return open_isf(file);
}

}  // namespace handcast::content
