// SPDX-License-Identifier: Apache-2.0
#include <RtMidi.h>
#include <fmt/format.h>

#include <mutex>
#include <optional>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/desk/midi/port/port.hpp"

namespace handcast::desk::midi {
namespace {

constexpr std::size_t kMostWaiting = 1024;
constexpr std::size_t kMostBytes = 3;  ///< of a message; longer ones are of no use here
constexpr std::string_view kJack = "jack:";

/// With it, the library neither prints nor throws; isPortOpen() tells what became of a port.
void ignore_errors(RtMidiError::Type, const std::string&, void*) {}

std::vector<std::string> names_of(RtMidi& midi) {
  std::vector<std::string> names;
  for (unsigned int i = 0; i < midi.getPortCount(); ++i) names.push_back(midi.getPortName(i));
  return names;
}

/// The first port whose name has this part.
std::optional<unsigned int> find_port(const std::vector<std::string>& names,
                                      std::string_view part) {
  for (unsigned int i = 0; i < names.size(); ++i)
    if (names[i].find(part) != std::string::npos) return i;
  return std::nullopt;
}

class RtMidiPort final : public Port {
 public:
  RtMidiPort(RtMidi::Api api, std::string part)
      : part_(std::move(part)), in_(api, "handcast"), out_(api, "handcast") {
    in_.setErrorCallback(&ignore_errors, nullptr);
    out_.setErrorCallback(&ignore_errors, nullptr);
  }

  Result<void> open() {
    const auto names = names_of(in_);
    const auto found = find_port(names, part_);
    // Also a JACK without a server looks like this.
    if (names.empty()) return fail(Errc::unavailable, "there is no MIDI device at all");
    if (!found)
      return fail(Errc::disconnected, fmt::format("there is no MIDI device {}; there are: {}",
                                                  quote(part_), join(names, ", ")));
    name_ = names[*found];
    in_.setCallback([](double, std::vector<unsigned char>* message,
                       void* port) { static_cast<RtMidiPort*>(port)->take(*message); },
                    this);
    in_.ignoreTypes(true, true, true);
    in_.openPort(*found, "in");
    if (!in_.isPortOpen())
      return fail(Errc::disconnected,
                  fmt::format("{} cannot be opened; does another program use it?", quote(name_)));
    if (const auto out = find_port(names_of(out_), part_)) out_.openPort(*out, "out");
    return {};
  }

  const std::string& name() const override { return name_; }

  std::vector<std::vector<std::uint8_t>> receive() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

  void send(std::span<const std::uint8_t> message) override {
    if (!out_.isPortOpen()) return;
    try {
      out_.sendMessage(message.data(), message.size());
    } catch (const RtMidiError&) {  // is_there() finds out that it is gone
    }
  }

  bool is_there() override {
    try {
      return find_port(names_of(in_), name_).has_value();
    } catch (const RtMidiError&) {
      return false;
    }
  }

 private:
  /// In a thread of the library.
  void take(const std::vector<unsigned char>& message) {
    if (message.empty() || message.size() > kMostBytes) return;
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMostWaiting) waiting_.push_back(message);
  }

  std::string part_, name_;
  std::mutex mutex_;
  std::vector<std::vector<std::uint8_t>> waiting_;
  RtMidiIn in_;  ///< below what its thread uses
  RtMidiOut out_;
};

}  // namespace

Result<std::unique_ptr<Port>> open_port(std::string_view device) {
  const bool is_jack = device.starts_with(kJack);
  const auto part = std::string(is_jack ? device.substr(kJack.size()) : device);
  try {
    auto port =
        std::make_unique<RtMidiPort>(is_jack ? RtMidi::UNIX_JACK : RtMidi::LINUX_ALSA, part);
    if (auto opened = port->open(); !opened) return tl::make_unexpected(opened.error());
    return port;
  } catch (const RtMidiError& error) {
    return fail(Errc::unavailable, fmt::format("this computer has no MIDI by {} ({})",
                                               is_jack ? "JACK" : "ALSA", error.getMessage()));
  }
}

}  // namespace handcast::desk::midi
