// SPDX-License-Identifier: Apache-2.0
#include "tests/services/projector/dlp/emulated_controller.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::test {
namespace {

using dlp::protocol::Bytes;
using dlp::protocol::Command;
using dlp::protocol::Controller;

constexpr std::uint8_t kRead = 0x80, kReply = 0x40, kError = 0x20;
constexpr std::uint8_t kNotNow = 5, kBadValue = 6;
constexpr std::size_t kReport = 64;

/// Number of data bytes of a command that sets something; -1 if the number is free.
int size_of(Controller controller, Command command) {
  const bool is_350 = controller == Controller::dlpc350;
  switch (command) {
    case Command::led_currents:
      return 3;
    case Command::trigger_out_1:
      return is_350 ? 3 : 5;
    case Command::trigger_out_2:
      return is_350 ? 2 : 5;
    case Command::pattern_period:
      return 8;
    case Command::pattern_count:
      return is_350 ? 4 : 6;
    case Command::pattern_definition:
      return is_350 ? -1 : 12;
    default:
      return 1;
  }
}

std::uint32_t number_at(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i)
    number |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return number;
}

}  // namespace

EmulatedController::EmulatedController(Controller controller, const std::string& serial)
    : controller_(controller), serial_(serial), is_inverted_(controller == Controller::dlpc350) {
  reset();
  plug();
}

void EmulatedController::plug() {
  hid_ = std::make_unique<EmulatedHid>(controller_ == Controller::dlpc350 ? 0x6401 : 0xc900,
                                       serial_, [this](const auto& report) { take(report); });
}

void EmulatedController::unplug() {
  hid_.reset();
  const std::lock_guard lock(mutex_);
  incoming_.clear();
}

/// The state of a firmware after switching on: an own pattern is shown, at currents of its own.
void EmulatedController::reset() {
  settings_ = {{Command::power, {0}},
               {Command::led_enables, {0x0f}},
               {Command::led_currents, {0x97, 0x78, 0x7d}},
               {Command::display_mode, {1}}};
  running_ = true;
  definitions_.clear();
}

void EmulatedController::inject(const std::vector<Fault>& faults) {
  const std::lock_guard lock(mutex_);
  faults_.insert(faults_.end(), faults.begin(), faults.end());
}
void EmulatedController::set_signal(bool there) {
  const std::lock_guard lock(mutex_);
  signal_ = there;
}
void EmulatedController::set_hardware_status(std::uint8_t bits) {
  const std::lock_guard lock(mutex_);
  hardware_ = bits;
}
void EmulatedController::restart() {
  const std::lock_guard lock(mutex_);
  reset();
}
std::vector<Received> EmulatedController::received() const {
  const std::lock_guard lock(mutex_);
  return received_;
}
void EmulatedController::forget() {
  const std::lock_guard lock(mutex_);
  received_.clear();
}
std::vector<std::string> EmulatedController::complaints() const {
  const std::lock_guard lock(mutex_);
  return complaints_;
}
bool EmulatedController::is_running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}
double EmulatedController::highest_current() const {
  const std::lock_guard lock(mutex_);
  return highest_;
}

double EmulatedController::share_of(std::uint8_t level) const {
  return (is_inverted_ ? 255 - level : level) / 255.0;
}

void EmulatedController::exchange_led_drivers() {
  const std::lock_guard lock(mutex_);
  is_inverted_ = !is_inverted_;
}

bool EmulatedController::is_lit() const {
  const std::lock_guard lock(mutex_);
  const auto& currents = settings_.at(Command::led_currents);
  const auto enables = settings_.at(Command::led_enables).front();
  for (std::size_t led = 0; led < 3; ++led)
    if ((enables >> led & 1) != 0 && share_of(currents[led]) > 0) return true;
  return false;
}

void EmulatedController::complain(const std::string& sentence) {
  complaints_.push_back(fmt::format("message {}: {}", received_.size(), sentence));
}

/// Puts a message together from its reports.
void EmulatedController::take(const NumberedReport& report) {
  const std::lock_guard lock(mutex_);
  if (report[0] != 0) complain(fmt::format("its report has the number {}", report[0]));
  incoming_.insert(incoming_.end(), report.begin() + 1, report.end());
  const std::size_t whole = 4 + number_at(incoming_, 2, 2);
  if (incoming_.size() < whole) return;
  if (incoming_.size() - whole >= kReport) complain("it has a report too many");
  if (std::any_of(incoming_.begin() + static_cast<std::ptrdiff_t>(whole), incoming_.end(),
                  [](auto byte) { return byte != 0; }))
    complain("there is something behind its end");
  auto message = std::exchange(incoming_, {});
  message.resize(whole);
  carry_out(message);
}

void EmulatedController::carry_out(const Bytes& message) {
  const auto flags = message[0], sequence = message[1];
  if (message.size() < 6) return complain("it has no command");
  const Received taken{.is_read = (flags & kRead) != 0,
                       .command = static_cast<Command>(number_at(message, 4, 2)),
                       .data = {message.begin() + 6, message.end()}};
  received_.push_back(taken);
  if (flags != (taken.is_read ? kRead | kReply : kReply))
    complain(fmt::format("its flags are {:02x}", flags));
  if (taken.is_read && !taken.data.empty()) complain("it reads with data");
  const int size = size_of(controller_, taken.command);
  if (!taken.is_read && size >= 0 && static_cast<int>(taken.data.size()) != size)
    complain(fmt::format("{} has {} bytes of data", name_of(taken.command), taken.data.size()));

  const auto fault = faults_.empty() ? Fault::none : faults_.front();
  if (!faults_.empty()) faults_.pop_front();
  if (fault == Fault::silence) return;
  const bool done = fault != Fault::refusal && (taken.is_read || obey(taken));
  const auto data = taken.is_read && done ? answer(taken.command) : Bytes();
  reply(static_cast<std::uint8_t>((flags & kRead) | (done ? 0 : kError)), sequence, data, fault);
}

/// Returns false if it refuses the command.
bool EmulatedController::obey(const Received& message) {
  error_code_ = kNotNow;
  if (message.command == Command::led_currents)
    for (const auto level : message.data) highest_ = std::max(highest_, share_of(level));
  switch (message.command) {
    case Command::power:
    case Command::led_currents:
    case Command::led_enables:
    case Command::source:
    case Command::pixel_format:
      settings_[message.command] = message.data;
      return true;
    case Command::display_mode: {
      if (running_ && message.data.front() != 0) return false;  // stop first
      const bool is_video_pattern = message.data.front() == 2;
      if (is_video_pattern && (controller_ == Controller::dlpc350 || !signal_ ||
                               settings_[Command::display_mode].front() != 0))
        return false;
      settings_[message.command] = message.data;
      reads_until_change_ = is_video_pattern ? 2 : 0;
      running_ = false;
      starts_ = 0;
      return true;
    }
    default:
      return obey_pattern_command(message);
  }
}

bool EmulatedController::obey_pattern_command(const Received& message) {
  const bool is_350 = controller_ == Controller::dlpc350;
  const auto mode = settings_[Command::display_mode].front();
  if (message.command == Command::pattern_display) {
    if (mode == 0) return false;
    if (message.data.front() == 2) return start();
    running_ = false;
    return true;
  }
  if (running_ || mode != (is_350 ? 1 : 2)) return false;
  if (is_350 && message.command == Command::pattern_definition) {
    if (settings_[Command::mailbox] != Bytes{2}) return false;
    for (std::size_t i = 0; i + 2 < message.data.size(); i += 3)
      definitions_.emplace_back(message.data.begin() + static_cast<std::ptrdiff_t>(i),
                                message.data.begin() + static_cast<std::ptrdiff_t>(i + 3));
  } else if (is_350 && message.command == Command::mailbox_address) {
    definitions_.clear();
  } else if (message.command == Command::pattern_definition) {
    error_code_ = kBadValue;
    if (number_at(message.data, 2, 3) < 105) return false;
    if (number_at(message.data, 0, 2) == 0) definitions_.clear();
    definitions_.push_back(message.data);
  }
  validated_ = message.command == Command::validate;
  if (validated_) reads_until_change_ = 1;
  settings_[message.command] = message.data;
  return true;
}

/// A DLPC350 that comes from another mode ignores the first start.
bool EmulatedController::start() {
  if (definitions_.empty()) return false;
  const bool is_350 = controller_ == Controller::dlpc350;
  const auto& count = settings_[Command::pattern_count];
  const auto wanted = is_350 ? count[0] + 1u : number_at(count, 0, 2);
  if (wanted != definitions_.size()) complain("it starts with another number of patterns");
  if (is_350 && !validated_) complain("it starts without a validation");
  if (!is_350 || starts_++ > 0) running_ = true;
  return true;
}

Bytes EmulatedController::answer(Command command) {
  const bool is_350 = controller_ == Controller::dlpc350;
  switch (command) {
    case Command::error_code:
      return {error_code_};
    case Command::version:
      return {2, 0, 1, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    case Command::video_signal: {
      Bytes signal(28, 0);
      signal[0] = signal_ ? 2 : 1;
      return signal;
    }
    case Command::hardware_status:
      return {hardware_};
    case Command::system_status:
      return {1};
    case Command::main_status:
      return {static_cast<std::uint8_t>((running_ ? 2 : 0) | (signal_ && !is_350 ? 8 : 0))};
    case Command::validate: {
      if (reads_until_change_-- > 0) return {0x80};
      const bool too_short = number_at(settings_[Command::pattern_period], 0, 4) < 235;
      return {static_cast<std::uint8_t>(too_short ? 1 : 0)};
    }
    case Command::display_mode:
      if (reads_until_change_ > 0 && --reads_until_change_ > 0) return {0};
      return settings_[command];
    default:
      return settings_[command];
  }
}

void EmulatedController::reply(std::uint8_t flags, std::uint8_t sequence, const Bytes& data,
                               Fault fault) {
  if (fault == Fault::lost_reply) return;
  Bytes message{flags, sequence, static_cast<std::uint8_t>(data.size()), 0};
  message.insert(message.end(), data.begin(), data.end());
  if (fault == Fault::stray_first || fault == Fault::wrong_sequence) {
    auto stray = message;
    stray[1] = static_cast<std::uint8_t>(sequence + 100);
    send(stray);
    if (fault == Fault::wrong_sequence) return;
  }
  if (fault == Fault::absurd_length) message[2] = message[3] = 0xff;
  if (fault == Fault::short_report) return hid_->send(message.data(), 3);
  if (fault == Fault::cut_reply) {
    message[2] = 40;
    return hid_->send(message.data(), 20 > message.size() ? message.size() : 20);
  }
  send(message);
}

/// Sends a message in whole reports.
void EmulatedController::send(Bytes message) {
  message.resize((message.size() + kReport - 1) / kReport * kReport);
  for (std::size_t at = 0; at < message.size(); at += kReport)
    hid_->send(message.data() + at, kReport);
}

}  // namespace handcast::test
