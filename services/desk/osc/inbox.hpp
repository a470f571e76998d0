// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/base/cue_deck.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/osc/addresses.hpp"

namespace handcast::desk::osc {

/// A time on two clocks, ns: CLOCK_MONOTONIC, and CLOCK_REALTIME, of which time tags are.
struct Instant {
  std::int64_t mono_ns = 0, wall_ns = 0;

  static Instant now();
};

/// What messages ask for, until it is done: of each control only the newest value is kept, so that
/// a flood of messages costs what one costs. All queues are bounded. One thread.
class Inbox {
 public:
  /// All references must outlive this object.
  Inbox(const Addresses& addresses, Complaints& complaints)
      : addresses_(addresses), complaints_(complaints), values_(addresses.controls().size()) {}

  /// Takes a datagram. `from`: its sender, e.g. "10.0.0.7". What is wrong with it is a complaint.
  void take(Bytes packet, std::string_view from, Instant now);
  /// Takes the bundles whose time has come. Call it before take(), some hundred times a second at
  /// most: between two calls, patterns are searched for a bounded time.
  void take_due(Instant now);
  /// When the next bundle is due, CLOCK_MONOTONIC; empty if none waits.
  std::optional<std::int64_t> next_due_ns() const;

  /// True if apply() has something to do.
  bool has_work() const { return !changed_.empty() || !shown_.empty() || !commands_.empty(); }
  /// Does all that was asked for. `cues` may be null.
  void apply(Panel& panel, CueDeck* cues, Instant now);
  /// True once after a "/refresh".
  bool takes_refresh() { return std::exchange(is_refresh_, false); }

 private:
  struct Waiting {
    std::string bundle, from;
  };
  struct Command {
    std::string address, argument;
  };
  void take_packet(Bytes packet, Instant now, int depth);
  void take_bundle(Bytes packet, Instant now, int depth);
  void take_message(const Message& message, Instant now);
  bool take_content(const Message& message, Instant now);
  bool take_command(const Message& message, Instant now);
  void wait_for(std::int64_t due_ns, Bytes bundle, Instant now);
  void keep(std::size_t control, const Message& message, Instant now);
  void keep_all(const Message& message, Instant now);
  void set_values(Panel& panel, Instant now);
  Result<void> obey(const Command& command, Panel& panel, CueDeck* cues);
  void complain(Instant now, std::string_view sentence);

  const Addresses& addresses_;
  Complaints& complaints_;
  std::vector<std::string> values_;               ///< by control: the newest assignment, or ""
  std::vector<std::size_t> changed_;              ///< the controls that have one, oldest first
  std::map<std::string, std::string> shown_;      ///< content by hand
  std::vector<Command> commands_;                 ///< in their order
  std::multimap<std::int64_t, Waiting> waiting_;  ///< bundles by the time that they are due
  std::size_t waiting_bytes_ = 0;
  std::string from_;    ///< the sender of the packet that is being taken
  std::string source_;  ///< who asked for what is kept
  int steps_ = 0;       ///< that patterns may still take until the next take_due()
  bool is_refresh_ = false;
};

}  // namespace handcast::desk::osc
