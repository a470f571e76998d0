// SPDX-License-Identifier: Apache-2.0
#include "ipc/client/rig_ring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/base/join.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/control/control_client.hpp"

namespace handcast::client {
namespace {

/// The names in an answer to Verb::rings; anything else than a text counts as a nameless ring.
std::vector<std::string> names_in(const nlohmann::json& answer) {
  std::vector<std::string> names;
  if (const auto rings = answer.find("rings"); rings != answer.end() && rings->is_array())
    for (const auto& name : *rings)
      names.push_back(name.is_string() ? name.get<std::string>() : std::string());
  return names;
}

}  // namespace

Result<RigRing> rig_ring(const std::string& rig, std::string_view stream,
                         std::chrono::nanoseconds patience) {
  const auto chosen = control::choose_rig(rig);
  if (!chosen) return tl::make_unexpected(chosen.error());
  auto answer = control::ask_with_descriptors(*chosen, {.verb = control::Verb::rings}, patience);
  if (!answer) return tl::make_unexpected(answer.error());

  const auto names = names_in(answer->object);
  const auto found = std::ranges::find(names, stream);
  if (stream.empty() || found == names.end())
    return fail(Errc::bad_config, fmt::format("rig '{}' has no stream '{}'; it has: {}", *chosen,
                                              stream, join(names, ", ")));
  // ask_with_descriptors() has checked that there is a descriptor for each name.
  auto segment = ipc::Segment::open(
      std::move(answer->descriptors[static_cast<std::size_t>(found - names.begin())]));
  if (!segment)
    return fail_in(fmt::format("stream '{}' of rig '{}'", stream, *chosen), segment.error());
  if (segment->stream() != stream)
    return fail(Errc::bad_data, fmt::format("rig '{}' gave the ring of '{}' for stream '{}'",
                                            *chosen, segment->stream(), stream));
  return RigRing{*chosen, std::move(*segment)};
}

Result<std::vector<std::string>> stream_names(const std::string& rig,
                                              std::chrono::nanoseconds patience) {
  const auto chosen = control::choose_rig(rig);
  if (!chosen) return tl::make_unexpected(chosen.error());
  const auto answer =
      control::ask_with_descriptors(*chosen, {.verb = control::Verb::rings}, patience);
  if (!answer) return tl::make_unexpected(answer.error());
  return names_in(answer->object);
}

}  // namespace handcast::client
