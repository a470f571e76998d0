// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/inbox.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/base/quote.hpp"
#include "services/desk/osc/pattern.hpp"

namespace handcast::desk::osc {
namespace {

constexpr int kDepth = 4;                  ///< of bundles in bundles
constexpr std::size_t kMostAddress = 255;  ///< bytes
constexpr std::size_t kMostWaiting = 256;  ///< bundles
constexpr std::size_t kMostWaitingBytes = 1 << 20;
constexpr std::size_t kMostCommands = 32;  ///< between two apply()
constexpr int kMostSteps = 50'000;         ///< of patterns between two take_due(): some 200 us
constexpr std::int64_t kMostAhead_ns = 60'000'000'000;
constexpr std::int64_t kSeconds1900 = 2'208'988'800;  ///< from 1900 to 1970

/// The time of a time tag, CLOCK_REALTIME.
std::int64_t wall_ns_of(std::uint64_t tag) {
  const auto seconds = static_cast<std::int64_t>(tag >> 32) - kSeconds1900;
  const auto fraction = static_cast<std::int64_t>((tag & 0xffffffff) * 1'000'000'000 >> 32);
  return seconds * 1'000'000'000 + fraction;
}

/// A button sends 1 when it is pressed and 0 when it is released; no argument is a press.
bool is_press(const Message& message) {
  return message.count == 0 || !message.all[0].is_number() || message.all[0].number != 0;
}

}  // namespace

Instant Instant::now() {
  timespec wall{};
  ::clock_gettime(CLOCK_REALTIME, &wall);
  return {now_ns(), static_cast<std::int64_t>(wall.tv_sec) * 1'000'000'000 + wall.tv_nsec};
}

void Inbox::complain(Instant now, std::string_view sentence) {
  complaints_.add(now.mono_ns, fmt::format("{}: {}", from_, sentence));
}

void Inbox::take(Bytes packet, std::string_view from, Instant now) {
  from_ = from;
  take_packet(packet, now, 0);
}

void Inbox::take_due(Instant now) {
  steps_ = kMostSteps;
  while (!waiting_.empty() && waiting_.begin()->first <= now.mono_ns) {
    const auto due = waiting_.extract(waiting_.begin());
    const auto& [bundle, from] = due.mapped();
    waiting_bytes_ -= bundle.size();
    from_ = from;
    take_packet({reinterpret_cast<const std::uint8_t*>(bundle.data()), bundle.size()},
                {now.mono_ns, INT64_MAX}, 0);  // all of it is due
  }
}

std::optional<std::int64_t> Inbox::next_due_ns() const {
  return waiting_.empty() ? std::nullopt : std::optional(waiting_.begin()->first);
}

void Inbox::take_packet(Bytes packet, Instant now, int depth) {
  if (is_bundle(packet)) return take_bundle(packet, now, depth);
  const auto message = read_message(packet);
  message ? take_message(*message, now) : complain(now, message.error().what);
}

void Inbox::take_bundle(Bytes packet, Instant now, int depth) {
  if (depth == kDepth)
    return complain(now, fmt::format("a bundle in more than {} others was dropped", kDepth - 1));
  const auto bundle = read_bundle(packet);
  if (!bundle) return complain(now, bundle.error().what);
  if (bundle->time_tag != kAtOnce)
    if (const auto wall_ns = wall_ns_of(bundle->time_tag); wall_ns > now.wall_ns) {
      const auto ahead_ns = wall_ns - now.wall_ns;
      if (ahead_ns <= kMostAhead_ns) return wait_for(now.mono_ns + ahead_ns, packet, now);
      return complain(now,
                      fmt::format("a bundle for a time {:.0f} s ahead was dropped; the most is "
                                  "60 s; are the clocks of both computers right?",
                                  ns_to_seconds(ahead_ns)));
    }
  for (const auto element : bundle->elements) take_packet(element, now, depth + 1);
}

void Inbox::wait_for(std::int64_t due_ns, Bytes bundle, Instant now) {
  if (waiting_.size() == kMostWaiting || waiting_bytes_ + bundle.size() > kMostWaitingBytes)
    return complain(now, "a bundle for a later time was dropped, because too many are waiting");
  waiting_bytes_ += bundle.size();
  waiting_.emplace(due_ns,
                   Waiting{{reinterpret_cast<const char*>(bundle.data()), bundle.size()}, from_});
}

void Inbox::take_message(const Message& message, Instant now) {
  if (message.address.size() > kMostAddress)
    return complain(now, "a message with an address of more than 255 bytes was dropped");
  if (take_content(message, now) || take_command(message, now)) return;
  if (const auto control = addresses_.find(message.address)) return keep(*control, message, now);
  if (is_pattern(message.address)) return keep_all(message, now);
  complain(now, fmt::format("there is no address {}", quote(message.address)));
}

bool Inbox::take_content(const Message& message, Instant now) {
  constexpr std::string_view kContent = "/content/";
  if (!message.address.starts_with(kContent)) return false;
  const auto hand = message.address.substr(kContent.size());
  if (hand != "left" && hand != "right" && hand != "both") return false;
  if (message.count != 1 || !message.all[0].is_text()) {
    complain(now, fmt::format("{} takes one text (s)", message.address));
    return true;
  }
  if (hand == "both") shown_.clear();
  shown_[std::string(hand)] = message.all[0].text;
  source_ = from_;
  return true;
}

bool Inbox::take_command(const Message& message, Instant now) {
  const auto address = message.address;
  if (address == "/refresh") {
    is_refresh_ |= is_press(message);
    return true;
  }
  if (!address.starts_with("/cue/") && !address.starts_with("/preset/") && address != "/undo" &&
      address != "/redo")
    return false;
  if (!is_press(message)) return true;
  if (commands_.size() == kMostCommands) {
    complain(now, fmt::format("{} was dropped: too many commands at once", quote(address)));
    return true;
  }
  std::string argument;
  if (message.count > 0 && message.all[0].is_text()) argument = message.all[0].text;
  if (message.count > 0 && message.all[0].is_number())
    argument = fmt::format("{}", message.all[0].number);
  commands_.push_back({std::string(address), std::move(argument)});
  source_ = from_;
  return true;
}

void Inbox::keep(std::size_t control, const Message& message, Instant now) {
  auto assignment = assignment_of(addresses_.controls()[control], message);
  if (!assignment)
    return complain(now, fmt::format("{}: {}", address_of(addresses_.controls()[control].path),
                                     assignment.error().what));
  if (values_[control].empty()) changed_.push_back(control);
  values_[control] = std::move(*assignment);
  source_ = from_;
}

void Inbox::keep_all(const Message& message, Instant now) {
  const auto found = addresses_.find_all(message.address, steps_);
  if (steps_ <= 0)
    return complain(now, fmt::format("the pattern {} was dropped: finding what it stands for takes "
                                     "too long",
                                     quote(message.address)));
  if (found.empty()) complain(now, fmt::format("no address is like {}", quote(message.address)));
  for (const auto control : found) keep(control, message, now);
}

void Inbox::apply(Panel& panel, CueDeck* cues, Instant now) {
  from_ = source_;
  set_values(panel, now);
  const auto source = "osc " + source_;
  for (const auto& [hand, content] : std::exchange(shown_, {}))
    if (const auto shown = panel.show(hand, content, source); !shown)
      complain(now, fmt::format("/content/{}: {}", hand, shown.error().what));
  for (const auto& command : std::exchange(commands_, {}))
    if (const auto obeyed = obey(command, panel, cues); !obeyed)
      complain(now, fmt::format("{}: {}", quote(command.address), obeyed.error().what));
}

void Inbox::set_values(Panel& panel, Instant now) {
  std::vector<std::string> assignments;
  for (const auto control : std::exchange(changed_, {}))
    assignments.push_back(std::exchange(values_[control], {}));
  if (assignments.empty()) return;
  const auto source = "osc " + source_;
  const auto set = panel.set(assignments, source);
  if (set) return;
  if (set.error().code != Errc::bad_config || assignments.size() == 1)
    return complain(now, set.error().what);
  // One that the rig refuses must not cost the others.
  for (const auto& assignment : assignments)
    if (const auto alone = panel.set(std::span(&assignment, 1), source); !alone)
      complain(now, alone.error().what);
}

Result<void> Inbox::obey(const Command& command, Panel& panel, CueDeck* cues) {
  constexpr std::string_view kPreset = "/preset/";
  const std::string_view address = command.address;
  const auto source = "osc " + source_;
  if (address == "/undo") return panel.undo(source);
  if (address == "/redo") return panel.redo(source);
  if (address.starts_with(kPreset)) return panel.load(address.substr(kPreset.size()), source);
  if (!cues) return fail(Errc::bad_config, "there is no cue list; desk.cues names one");
  if (address == "/cue/jump") return cues->jump(command.argument);
  if (address == "/cue/go")
    cues->go();
  else if (address == "/cue/back")
    cues->back();
  else if (address == "/cue/hold")
    cues->hold();
  else if (address == "/cue/key")
    cues->key(command.argument);
  else
    return fail(Errc::bad_config, "there is /cue/go, /cue/back, /cue/hold, /cue/jump and /cue/key");
  return {};
}

}  // namespace handcast::desk::osc
