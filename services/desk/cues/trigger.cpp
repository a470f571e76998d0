// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/trigger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "ipc/base/quote.hpp"

namespace handcast::desk::cues {
namespace {

/// A number without a sign that is the whole text.
std::optional<double> read_number(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && number >= 0 && number < 1e9 ? std::optional(number) : std::nullopt;
}

/// "20:15" or "20:15:30" in seconds.
std::optional<double> read_time(std::string_view text) {
  double seconds = 0;
  int parts = 0;
  for (const double limit : {24, 60, 60}) {
    const auto part = text.substr(0, text.find(':'));
    const auto number = part.size() == 2 ? read_number(part) : std::nullopt;
    if (!number || *number >= limit || part.find('.') != part.npos) return std::nullopt;
    seconds = seconds * 60 + *number;
    ++parts;
    if (part.size() == text.size())
      return parts == 1 ? std::nullopt : std::optional(parts == 2 ? seconds * 60 : seconds);
    text.remove_prefix(part.size() + 1);
  }
  return std::nullopt;
}

/// One of Gestures.
bool is_event(std::string_view word) {
  constexpr std::array<std::string_view, 6> kOfAHand{"appears", "leaves", "pinch",
                                                     "fist",    "open",   "point"};
  if (word == "touch") return true;
  const auto dot = word.find('.');
  const auto side = word.substr(0, dot);
  return dot != word.npos && (side == "left" || side == "right") &&
         std::ranges::find(kOfAHand, word.substr(dot + 1)) != kOfAHand.end();
}

}  // namespace

Result<Trigger> read_trigger(std::string_view text) {
  const auto space = text.find(' ');
  const auto word = text.substr(0, space);
  const auto rest = space == text.npos ? "" : text.substr(space + 1);
  using Kind = Trigger::Kind;
  if (word == "key" && !rest.empty()) return Trigger{Kind::key, std::string(rest), 0};
  if (word == "at")
    if (const auto time = read_time(rest)) return Trigger{Kind::at, "", *time};
  if (word == "idle" && rest.empty()) return Trigger{Kind::event, "idle", 0};
  if (word == "idle" || word == "after")
    if (const auto seconds = read_number(rest))
      return Trigger{word == "idle" ? Kind::idle : Kind::after, "", *seconds};
  if (is_event(text)) return Trigger{Kind::event, std::string(text), 0};
  return fail(
      Errc::bad_config,
      fmt::format("{} starts no cue; write \"key g\", \"at 20:15\", \"left.\" or \"right.\" "
                  "with appears, leaves, pinch, fist, open or point, \"touch\" (of the "
                  "other hand), \"idle 30\" (seconds without a hand), or \"after 5\" "
                  "(seconds after the cue before it)",
                  quote(text)));
}

}  // namespace handcast::desk::cues
