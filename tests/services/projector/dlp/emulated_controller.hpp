// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "services/projector/dlp/protocol/message.hpp"
#include "tests/services/projector/dlp/emulated_hid.hpp"

namespace handcast::test {

/// What goes wrong with one message.
enum class Fault {
  none,
  silence,         ///< no reply, and the message is ignored
  lost_reply,      ///< the message is carried out
  refusal,         ///< a reply with the error bit, and the message is ignored
  short_report,    ///< a reply of 3 bytes
  cut_reply,       ///< a reply that ends before its length
  wrong_sequence,  ///< a reply to another message
  stray_first,     ///< a reply to another message, then the right one
  absurd_length,   ///< a reply that claims to be 64 KiB long
};

/// A message as the controller got it.
struct Received {
  bool is_read = false;
  dlp::protocol::Command command{};
  dlp::protocol::Bytes data;
  bool operator==(const Received&) const = default;
};

/// A DLPC350 or DLPC900 behind an emulated USB port. It checks each byte of each report, keeps to
/// the order of commands that its manual asks for, and starts as its firmware does: with lit LEDs.
/// Any thread.
class EmulatedController {
 public:
  explicit EmulatedController(dlp::protocol::Controller controller,
                              const std::string& serial = "LCR7");

  /// The next messages get these faults, in their order.
  void inject(const std::vector<Fault>& faults);
  void set_signal(bool there);
  /// The LED drivers of another board than the controller's usual one.
  void exchange_led_drivers();
  void set_hardware_status(std::uint8_t bits);
  /// As if its power had failed for a moment.
  void restart();
  void stall(bool stalled) { hid_->stall(stalled); }
  void unplug();
  void plug();

  std::vector<Received> received() const;
  /// Forgets what was received.
  void forget();
  /// What was wrong with the reports and commands, one sentence each.
  std::vector<std::string> complaints() const;
  /// A LED that is enabled and has a current.
  bool is_lit() const;
  bool is_running() const;
  /// The largest share of a current that was ever commanded.
  double highest_current() const;

 private:
  using Bytes = dlp::protocol::Bytes;
  using Command = dlp::protocol::Command;

  void take(const NumberedReport& report);
  void carry_out(const Bytes& message);
  bool obey(const Received& message);
  bool obey_pattern_command(const Received& message);
  bool start();
  Bytes answer(Command command);
  void reply(std::uint8_t flags, std::uint8_t sequence, const Bytes& data, Fault fault);
  void send(Bytes message);
  void complain(const std::string& sentence);
  void reset();
  double share_of(std::uint8_t level) const;

  const dlp::protocol::Controller controller_;
  const std::string serial_;
  mutable std::mutex mutex_;
  Bytes incoming_;
  std::deque<Fault> faults_;
  std::vector<Received> received_;
  std::vector<std::string> complaints_;
  std::map<Command, Bytes> settings_;
  std::vector<Bytes> definitions_;
  bool signal_ = true, running_ = false, validated_ = false;
  int starts_ = 0, reads_until_change_ = 0;
  std::uint8_t hardware_ = 1, error_code_ = 0;
  double highest_ = 0;
  bool is_inverted_;
  std::unique_ptr<EmulatedHid> hid_;  ///< its thread calls take(): the last member
};

}  // namespace handcast::test
