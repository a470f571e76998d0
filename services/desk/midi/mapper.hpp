// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/base/cue_deck.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/midi/bindings.hpp"

namespace handcast::desk::midi {

/// A channel message: status and two data bytes.
using Bytes3 = std::array<std::uint8_t, 3>;

/// Turns messages of a controller into changes, and changes into messages to its motors and lamps.
/// Of each knob only the newest place is kept; all queues are bounded. One thread.
class Mapper {
 public:
  /// `controls` and `complaints` must outlive this object.
  Mapper(std::span<const Control> controls, std::vector<Binding> bindings, Complaints& complaints);

  const std::vector<Binding>& bindings() const { return bindings_; }

  /// Takes a message. Those of other kinds than controllers, keys and bends mean nothing here; what
  /// is no message is a complaint.
  void take(std::span<const std::uint8_t> message, std::int64_t now_ns);

  /// As MidiLearner. take() finds the source; a controller is waited for 200 ms, until it is clear
  /// whether it has 14 bits.
  /// @{
  Result<void> learn(std::string_view path, std::int64_t now_ns);
  void stop_learning() { learning_.clear(); }
  const std::string& learning() const { return learning_; }
  void forget(std::string_view path);
  /// @}
  /// Ends learning when it is time. True if there is a new binding, to be written down.
  bool learn_on(std::int64_t now_ns);

  /// Does what was moved since the last call. `cues` may be null.
  void apply(Panel& panel, CueDeck* cues, std::int64_t now_ns);

  /// The messages that show the values: to motors of faders and lamps of keys. What a person moves
  /// is left alone until they have let it go for 300 ms. At most 64 messages a call.
  std::vector<Bytes3> feedback(const Values& values, std::int64_t now_ns);
  /// Everything is shown again: the device was away.
  void forget_shown();

 private:
  /// Where a binding stands.
  struct Place {
    int raw = 0;               ///< 0..largest_of(); of a note: 127 while it is pressed
    std::optional<int> shown;  ///< what the device shows; empty: not known
    bool is_moved = false;     ///< since the last apply()
    int presses = 0;           ///< since then
    std::int64_t touched_ns = -(1LL << 62);
  };
  /// A message that says where something is.
  struct Move {
    Source source = Source::controller;
    int channel = 1, number = 0, raw = 0;
  };
  static std::optional<Move> read(std::span<const std::uint8_t> message);
  static std::optional<int> raw_of(const Binding& binding, const Move& move, int raw);
  void move(std::size_t binding, int raw, std::int64_t now_ns);
  void notice(const Move& move, std::int64_t now_ns);
  void bind(const Move& move);
  Result<std::string> assignment_of(std::size_t binding, const Values& values) const;
  void obey(const std::string& command, Panel& panel, CueDeck* cues, std::int64_t now_ns);
  int raw_to_show(std::size_t binding, const Values& values) const;

  std::span<const Control> controls_;
  std::vector<Binding> bindings_;
  std::vector<Place> places_;  ///< by binding
  Complaints& complaints_;
  std::vector<std::string> commands_;

  std::string learning_;
  std::int64_t learn_until_ns_ = 0;
  std::vector<Move> noticed_;  ///< controllers that were moved while learning; the first counts
  bool has_learned_ = false;
};

}  // namespace handcast::desk::midi
