// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/own_finder.hpp"

#include <fmt/format.h>

#include "services/landmarks/finder/models.hpp"
#include "services/landmarks/finder/own_network.hpp"

namespace handcast::landmarks::own {
namespace fs = std::filesystem;

static constexpr const char* kExecutor = "onednn";

Result<HandFinder> open_finder(const fs::path& models, int most_hands) {
  std::error_code ignored;
  const fs::path file = default_network_file();
  if (!fs::exists(file, ignored))
    return fail(
        Errc::bad_config,
        fmt::format(
            "'{}', which comes with handcast, is missing; HANDCAST_ASSETS may name another folder",
            file.string()));
  auto hand = OwnNetwork::open(kExecutor, file);
  if (!hand) return tl::make_unexpected(hand.error());
  std::optional<PalmNetwork> palm;
  if (fs::exists(models / kPalmModel, ignored)) {
    auto opened = PalmNetwork::open(kExecutor, models);
    if (!opened) return tl::make_unexpected(opened.error());
    palm = std::move(*opened);
  }
  return HandFinder(std::make_unique<OwnNetwork>(std::move(*hand)), std::move(palm), most_hands);
}

}  // namespace handcast::landmarks::own
