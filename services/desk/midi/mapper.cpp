// SPDX-License-Identifier: Apache-2.0
#include "services/desk/midi/mapper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/desk/controls/control_value.hpp"

namespace handcast::desk::midi {
namespace {

constexpr std::int64_t kLearnFor_ns = 30'000'000'000;
constexpr std::int64_t kFinePart_ns =
    200'000'000;                                 ///< the lower bits of a controller follow within
constexpr std::int64_t kLetGo_ns = 300'000'000;  ///< a knob that does not move is let go
constexpr std::size_t kMostCommands = 32;        ///< between two apply()
constexpr std::size_t kMostShown = 64;           ///< messages of one feedback()
constexpr std::size_t kMostNoticed = 64;
constexpr int kPressed = 64;  ///< a switch that is a controller is on from here up

constexpr int kNoteOff = 0x80, kNoteOn = 0x90, kController = 0xb0, kBend = 0xe0;

double least_of(const Binding& binding, const Control& control) {
  if (control.kind == Kind::choice) return 0;
  return binding.min.value_or(control.range.min);
}
double most_of(const Binding& binding, const Control& control) {
  if (control.kind == Kind::choice) return static_cast<double>(control.words.size()) - 1;
  return binding.max.value_or(control.range.max);
}

Bytes3 message_of(int status, int channel, int first, int second) {
  return {static_cast<std::uint8_t>(status | (channel - 1)), static_cast<std::uint8_t>(first),
          static_cast<std::uint8_t>(second)};
}

/// The messages that bring a source to a place.
void add_messages(const Binding& binding, int raw, std::vector<Bytes3>& messages) {
  const int upper = raw >> 7, lower = raw & 0x7f;
  switch (binding.source) {
    case Source::controller:
      messages.push_back(message_of(kController, binding.channel, binding.number, raw));
      break;
    case Source::controller14:
      messages.push_back(message_of(kController, binding.channel, binding.number, upper));
      messages.push_back(message_of(kController, binding.channel, binding.number + 32, lower));
      break;
    case Source::bend:
      messages.push_back(message_of(kBend, binding.channel, lower, upper));
      break;
    case Source::note:
      messages.push_back(message_of(kNoteOn, binding.channel, binding.number, raw));
      break;
  }
}

}  // namespace

Mapper::Mapper(std::span<const Control> controls, std::vector<Binding> bindings,
               Complaints& complaints)
    : controls_(controls),
      bindings_(std::move(bindings)),
      places_(bindings_.size()),
      complaints_(complaints) {}

std::optional<Mapper::Move> Mapper::read(std::span<const std::uint8_t> message) {
  const int kind = message[0] & 0xf0, channel = (message[0] & 0x0f) + 1;
  const int first = message[1], second = message[2];
  if (kind == kController) return Move{Source::controller, channel, first, second};
  if (kind == kBend) return Move{Source::bend, channel, 0, second << 7 | first};
  if (kind == kNoteOn) return Move{Source::note, channel, first, second};
  if (kind == kNoteOff) return Move{Source::note, channel, first, 0};
  return std::nullopt;
}

void Mapper::take(std::span<const std::uint8_t> message, std::int64_t now_ns) {
  if (message.empty() || message[0] < 0x80)
    return complaints_.add(now_ns, "a message without a status byte was dropped");
  const int kind = message[0] & 0xf0;
  if (kind != kController && kind != kBend && kind != kNoteOn && kind != kNoteOff) return;
  if (message.size() != 3 || message[1] > 0x7f || message[2] > 0x7f)
    return complaints_.add(
        now_ns, fmt::format("a message 0x{:02x} that is not whole was dropped", message[0]));
  const auto read_move = read(message);
  if (!learning_.empty()) return notice(*read_move, now_ns);
  for (std::size_t i = 0; i < bindings_.size(); ++i)
    if (const auto raw = raw_of(bindings_[i], *read_move, places_[i].raw)) move(i, *raw, now_ns);
}

/// Where a message brings a binding that is at `raw`; empty if it is not of its source.
std::optional<int> Mapper::raw_of(const Binding& binding, const Move& move, int raw) {
  if (binding.channel != move.channel) return std::nullopt;
  if (binding.source == Source::controller14) {
    if (move.source != Source::controller) return std::nullopt;
    if (move.number == binding.number) return move.raw << 7;  // the lower bits follow
    if (move.number == binding.number + 32) return (raw & ~0x7f) | move.raw;
    return std::nullopt;
  }
  const bool is_same = binding.source == move.source &&
                       (binding.source == Source::bend || binding.number == move.number);
  if (!is_same) return std::nullopt;
  return move.source == Source::note ? (move.raw > 0 ? 127 : 0) : move.raw;
}

void Mapper::move(std::size_t binding, int raw, std::int64_t now_ns) {
  auto& place = places_[binding];
  const int pressed = bindings_[binding].source == Source::note ? 127 : kPressed;
  const bool is_press = raw >= pressed && place.raw < pressed;
  place.raw = raw;
  place.touched_ns = now_ns;
  place.is_moved = true;
  // A fader stands where it is; the lamp of a key may do anything.
  place.shown = bindings_[binding].source == Source::note ? std::nullopt : std::optional(raw);
  if (!is_press) return;
  ++place.presses;
  if (!is_command(bindings_[binding].path)) return;
  if (commands_.size() < kMostCommands)
    commands_.push_back(bindings_[binding].path);
  else
    complaints_.add(now_ns, "a command was dropped: too many at once");
}

Result<void> Mapper::learn(std::string_view path, std::int64_t now_ns) {
  // A fader can turn whatever can be turned at all.
  if (auto fault = fault_of({.path = std::string(path)}, controls_); !fault.empty())
    return fail(Errc::bad_config, std::move(fault));
  learning_ = path;
  learn_until_ns_ = now_ns + kLearnFor_ns;
  noticed_.clear();
  return {};
}

void Mapper::forget(std::string_view path) {
  for (std::size_t i = bindings_.size(); i-- > 0;)
    if (bindings_[i].path == path) {
      bindings_.erase(bindings_.begin() + static_cast<std::ptrdiff_t>(i));
      places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

/// A message while learning.
void Mapper::notice(const Move& move, std::int64_t now_ns) {
  if (move.source == Source::controller) {
    if (noticed_.empty()) learn_until_ns_ = now_ns + kFinePart_ns;
    if (noticed_.size() < kMostNoticed) noticed_.push_back(move);
    return;
  }
  if (move.source == Source::note && move.raw == 0) return;  // it is let go
  bind(move);
}

void Mapper::bind(const Move& move) {
  Binding binding{learning_, move.source, move.channel, move.number, {}, {}};
  const auto has_noticed = [&](int number) {
    return std::ranges::any_of(noticed_, [&](const Move& other) {
      return other.channel == move.channel && other.number == number;
    });
  };
  if (move.source == Source::controller && move.number < 32 && has_noticed(move.number + 32)) {
    binding.source = Source::controller14;
  } else if (move.source == Source::controller && move.number >= 32 && move.number < 64 &&
             has_noticed(move.number - 32)) {
    binding.source = Source::controller14;
    binding.number -= 32;
  }
  learning_.clear();
  if (const auto fault = fault_of(binding, controls_); !fault.empty())
    return complaints_.add(learn_until_ns_, fault);
  const auto is_of_source = [&](const Binding& other) {
    return other.source == binding.source && other.channel == binding.channel &&
           other.number == binding.number;
  };
  forget(binding.path);
  for (auto found = std::ranges::find_if(bindings_, is_of_source); found != bindings_.end();
       found = std::ranges::find_if(bindings_, is_of_source))
    forget(std::string(found->path));
  bindings_.push_back(std::move(binding));
  places_.emplace_back();
  has_learned_ = true;
}

bool Mapper::learn_on(std::int64_t now_ns) {
  if (!learning_.empty() && now_ns >= learn_until_ns_) {
    if (noticed_.empty())
      learning_.clear();
    else
      bind(noticed_.front());
  }
  return std::exchange(has_learned_, false);
}

Result<std::string> Mapper::assignment_of(std::size_t binding, const Values& values) const {
  const auto& bound = bindings_[binding];
  const auto& place = places_[binding];
  const auto at = *find_control(controls_, bound.path);
  const auto& control = controls_[at];
  if (bound.source == Source::note) {
    // Each press is one step: of a toggle to the other side, of a choice to the next word.
    const int count = control.kind == Kind::toggle ? 2 : static_cast<int>(control.words.size());
    const auto now = static_cast<int>(number_of(control, values.toml[at]).value_or(0));
    return assign_number(control, (now + place.presses) % count);
  }
  if (control.kind == Kind::toggle) return assign_number(control, place.raw >= kPressed);
  const double share = static_cast<double>(place.raw) / largest_of(bound.source);
  const double least = least_of(bound, control), most = most_of(bound, control);
  const double number = least + share * (most - least);
  const bool is_whole = control.kind != Kind::number;
  return assign_number(control, is_whole ? std::round(number) : number, !is_whole);
}

void Mapper::apply(Panel& panel, CueDeck* cues, std::int64_t now_ns) {
  for (const auto& command : std::exchange(commands_, {})) obey(command, panel, cues, now_ns);
  std::vector<std::string> assignments;
  const auto values = panel.values();
  for (std::size_t i = 0; i < bindings_.size(); ++i) {
    if (!std::exchange(places_[i].is_moved, false) || is_command(bindings_[i].path)) {
      places_[i].presses = 0;
      continue;
    }
    const bool is_release = bindings_[i].source == Source::note && places_[i].presses == 0;
    if (!is_release) {
      auto assignment = assignment_of(i, *values);
      assignment ? assignments.push_back(std::move(*assignment))
                 : complaints_.add(now_ns, assignment.error().what);
    }
    places_[i].presses = 0;
  }
  if (assignments.empty()) return;
  if (const auto set = panel.set(assignments, "midi"); !set)
    complaints_.add(now_ns, set.error().what);
}

void Mapper::obey(const std::string& command, Panel& panel, CueDeck* cues, std::int64_t now_ns) {
  const auto argument = command.substr(std::min(command.find(' '), command.size() - 1) + 1);
  Result<void> obeyed;
  if (command == "undo")
    obeyed = panel.undo("midi");
  else if (command == "redo")
    obeyed = panel.redo("midi");
  else if (command.starts_with("preset "))
    obeyed = panel.load(argument, "midi");
  else if (!cues)
    obeyed = fail(Errc::bad_config, "there is no cue list; desk.cues names one");
  else if (command == "cue.go")
    cues->go();
  else if (command == "cue.back")
    cues->back();
  else if (command == "cue.hold")
    cues->hold();
  else if (command.starts_with("cue.jump "))
    obeyed = cues->jump(argument);
  else
    cues->key(argument);
  if (!obeyed) complaints_.add(now_ns, fmt::format("{}: {}", command, obeyed.error().what));
}

int Mapper::raw_to_show(std::size_t binding, const Values& values) const {
  const auto& bound = bindings_[binding];
  const auto at = *find_control(controls_, bound.path);
  const auto& control = controls_[at];
  const double number = number_of(control, values.toml[at]).value_or(0);
  const int largest = largest_of(bound.source);
  if (control.kind == Kind::toggle || bound.source == Source::note) return number > 0 ? largest : 0;
  const double least = least_of(bound, control), most = most_of(bound, control);
  const double share = most == least ? 0 : (number - least) / (most - least);
  return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * largest));
}

std::vector<Bytes3> Mapper::feedback(const Values& values, std::int64_t now_ns) {
  std::vector<Bytes3> messages;
  for (std::size_t i = 0; i < bindings_.size() && messages.size() + 2 <= kMostShown; ++i) {
    auto& place = places_[i];
    if (is_command(bindings_[i].path) || now_ns - place.touched_ns < kLetGo_ns) continue;
    const int raw = raw_to_show(i, values);
    if (place.shown == raw) continue;
    place.shown = raw;
    if (bindings_[i].source != Source::note) place.raw = raw;
    add_messages(bindings_[i], raw, messages);
  }
  return messages;
}

void Mapper::forget_shown() {
  for (auto& place : places_) place.shown.reset();
}

}  // namespace handcast::desk::midi
