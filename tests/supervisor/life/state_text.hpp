// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "supervisor/life/next.hpp"

namespace handcast::supervisor {

/// States and actions as text, for tables of expectations. Times are in seconds.
struct StateText {
  static std::string at(std::int64_t time_ns) {
    return fmt::format("{:g}", ns_to_seconds(time_ns));
  }
  static std::string marks(const Life& life) {
    return fmt::format("{}{}",
                       life.origin == Origin::promoted  ? ", promoted"
                       : life.origin == Origin::adopted ? ", adopted"
                                                        : "",
                       life.on_trial ? ", on trial" : "");
  }

  std::string operator()(const worker::Stopped&) const { return "stopped"; }
  std::string operator()(const worker::Failed&) const { return "failed"; }
  std::string operator()(const worker::Held&) const { return "held"; }
  std::string operator()(const worker::Waiting& s) const {
    return fmt::format("waiting until {}{}", at(s.due_ns), s.degraded ? ", degraded" : "");
  }
  std::string operator()(const worker::Starting& s) const {
    return fmt::format("starting until {}{}", at(s.late_ns), marks(s.life));
  }
  std::string operator()(const worker::AwaitingMessage& s) const {
    return fmt::format("awaiting its message, dry for {}{}", at(s.dry_ns), marks(s.life));
  }
  std::string operator()(const worker::Ready& s) const {
    return fmt::format("ready since {}, quiet from {}{}", at(s.ready_ns), at(s.quiet_from_ns),
                       marks(s.life));
  }
  std::string operator()(const worker::Killed& s) const { return "killed" + marks(s.life); }
  std::string operator()(const worker::Stopping& s) const {
    constexpr std::array kThen{"", ", then start", ", then start on trial", ", then hand over"};
    return fmt::format("stopping{}{}", s.kill_ns ? " until " + at(*s.kill_ns) : ", killed",
                       kThen[static_cast<std::size_t>(s.then)]);
  }
  std::string operator()(const worker::AwaitingStandby&) const { return "awaiting its standby"; }

  std::string operator()(const standby::None&) const { return "none"; }
  std::string operator()(const standby::Due& s) const { return "due at " + at(s.start_ns); }
  std::string operator()(const standby::Preparing& s) const {
    return "preparing until " + at(s.late_ns);
  }
  std::string operator()(const standby::Prepared& s) const {
    return fmt::format("prepared, heard at {}", at(s.sign_ns));
  }
  std::string operator()(const standby::Killed&) const { return "killed"; }
  std::string operator()(const standby::Leaving& s) const {
    return fmt::format("leaving{}{}", s.kill_ns ? " until " + at(*s.kill_ns) : ", killed",
                       s.start_ns ? ", next at " + at(*s.start_ns) : "");
  }

  std::string operator()(const action::Spawn&) const { return "spawn"; }
  std::string operator()(const action::Promote&) const { return "promote"; }
  std::string operator()(const action::HandOver&) const { return "hand over"; }
  std::string operator()(const action::ReplacementFailed& action) const {
    return fmt::format("replacement failed{}: {}", action.by_itself ? " by itself" : "",
                       action.why);
  }
  std::string operator()(const action::AskToStop& action) const {
    return action.for_good ? "ask to stop for good" : "ask to stop";
  }
  std::string operator()(const action::Kill&) const { return "kill"; }
  std::string operator()(const action::SpawnStandby&) const { return "spawn standby"; }
  std::string operator()(const action::AskStandbyToStop&) const { return "ask standby to stop"; }
  std::string operator()(const action::KillStandby&) const { return "kill standby"; }
  std::string operator()(const action::ReadLastWords&) const { return "read last words"; }
  std::string operator()(const action::Warn& action) const { return "warn: " + action.sentence; }
  std::string operator()(const action::Tell& action) const {
    constexpr std::array kNotices{"tell ready", "tell stopped", "tell failed"};
    return kNotices[static_cast<std::size_t>(action.notice)];
  }
};

template <class Variant>
std::string text_of(const Variant& variant) {
  return std::visit(StateText{}, variant);
}

inline std::vector<std::string> text_of(const std::vector<Action>& actions) {
  std::vector<std::string> texts;
  for (const auto& action : actions) texts.push_back(text_of(action));
  return texts;
}

/// A service without processes, on a clock of the test's own.
struct Machine {
  using Texts = std::vector<std::string>;

  /// What is to be done when this happens at a time.
  Texts at(double time_s, const Event& event) {
    auto step = next(state, event, seconds_to_ns(time_s), rules);
    state = std::move(step.state);
    return text_of(step.actions);
  }
  std::string worker() const { return text_of(state.worker); }
  std::string standby() const { return text_of(state.standby); }

  ServiceState state{};
  Rules rules{.name = "pose",
              .ready_ns = seconds_to_ns(10),
              .stop_ns = seconds_to_ns(3),
              .silent_ns = seconds_to_ns(2),
              .publishes = false,
              .wants_standby = false};
};

}  // namespace handcast::supervisor
