// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/place_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/document.hpp"
#include "config/settings/files.hpp"
#include "config/settings/quoted.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::desk::cues {

Result<void> write_place(const std::filesystem::path& file, const KeptPlace& place) {
  // It outlasts the process, not a power cut: the desk must not wait for a disk.
  return write_whole(file,
                     fmt::format("# The place of the cue list, written by the desk.\n"
                                 "list = {}\ncue = {}\nstarted_s = {:.3f}\nis_faded = {}\n",
                                 config::quoted(place.list), config::quoted(place.cue),
                                 place.started_s, place.is_faded),
                     Durable::no);
}

Result<std::optional<KeptPlace>> read_place(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  const auto fault = [&] {
    return fail(Errc::bad_data, fmt::format("{}: the place of the cue list cannot be read; the "
                                            "list begins at its start",
                                            quote(file.string())));
  };
  const auto text = config::read_text(file);
  const auto document = text ? config::parse_document(*text, file.string()) : fault();
  if (!document) return fault();
  KeptPlace place;
  int found = 0;
  const auto take = [&](const auto* from, auto& into) {
    if (!from) return;
    into = *from;
    ++found;
  };
  for (const auto& [name, value] : std::get<config::Table>(document->data)) {
    if (name == "list") take(std::get_if<std::string>(&value.data), place.list);
    if (name == "cue") take(std::get_if<std::string>(&value.data), place.cue);
    if (name == "started_s") take(std::get_if<double>(&value.data), place.started_s);
    if (name == "is_faded") take(std::get_if<bool>(&value.data), place.is_faded);
  }
  if (found != 4) return fault();
  return place;
}

}  // namespace handcast::desk::cues
