// SPDX-License-Identifier: Apache-2.0
#include "services/desk/midi/midi.hpp"

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "config/settings/files.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/desk/midi/mapper.hpp"

namespace handcast::desk {
namespace midi {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPause(4);
constexpr seconds kLookEvery(1);
constexpr std::int64_t kLookEvery_ns = to_ns(kLookEvery);
/// A computer without MIDI may get it: by a module, by JACK's server.
constexpr seconds kLongestPause(32);

class Worker final : public MidiSurface {
 public:
  Worker(std::string device, std::filesystem::path file, std::vector<Binding> bindings,
         Panel& panel, CueDeck* cues, OpenMidiPort open)
      : device_(std::move(device)),
        file_(std::move(file)),
        panel_(panel),
        cues_(cues),
        open_(std::move(open)),
        mapper_(panel.controls(), std::move(bindings), complaints_),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void turn(const Scene&) override {}

  Result<void> learn(std::string_view path) override {
    const std::lock_guard lock(mutex_);
    return mapper_.learn(path, now_ns());
  }
  void stop_learning() override {
    const std::lock_guard lock(mutex_);
    mapper_.stop_learning();
  }
  void forget(std::string_view path) override {
    const std::lock_guard lock(mutex_);
    mapper_.forget(path);
    is_changed_ = true;
  }
  MidiState state() const override {
    const std::lock_guard lock(mutex_);
    MidiState state{name_, mapper_.learning(), {}};
    for (const auto& binding : mapper_.bindings())
      state.bindings.emplace_back(binding.path, print_source(binding));
    return state;
  }

 private:
  void run(const std::stop_token& stop) {
    auto pause = kLookEvery;
    while (!stop.stop_requested()) {
      if (look_for_device(pause)) {
        work(stop);
        pause = kLookEvery;
      }
      wait(stop, pause);
    }
  }

  void wait(const std::stop_token& stop, milliseconds time) {
    std::unique_lock lock(wait_mutex_);
    wakes_.wait_for(lock, stop, time, [] { return false; });
  }

  bool look_for_device(seconds& pause) {
    auto opened = open_(device_);
    if (!opened) {
      const auto& fault = opened.error();
      if (fault.what != said_)
        log::warning("desk.midi.device: {}; it is looked for again", fault.what);
      said_ = fault.what;
      pause = fault.code == Errc::disconnected ? kLookEvery : std::min(2 * pause, kLongestPause);
      {
        const std::lock_guard lock(mutex_);
        (void)mapper_.learn_on(now_ns());  // its time ends, too
      }
      write_if_changed();
      return false;
    }
    said_.clear();
    port_ = std::move(*opened);
    log::info("midi: {} is there", port_->name());
    const std::lock_guard lock(mutex_);
    name_ = port_->name();
    mapper_.forget_shown();
    return true;
  }

  /// Until the device is gone.
  void work(const std::stop_token& stop) {
    auto look_ns = now_ns() + kLookEvery_ns;
    while (!stop.stop_requested()) {
      const auto now = now_ns();
      if (now >= look_ns) {
        look_ns = now + kLookEvery_ns;
        if (!port_->is_there()) break;
      }
      exchange(now);
      write_if_changed();
      wait(stop, kPause);
    }
    if (!stop.stop_requested()) log::warning("midi: {} is gone; it is looked for", name_);
    port_.reset();
    const std::lock_guard lock(mutex_);
    name_.clear();
  }

  void exchange(std::int64_t now) {
    const auto messages = port_->receive();
    std::vector<Bytes3> answers;
    {
      const std::lock_guard lock(mutex_);
      for (const auto& message : messages) mapper_.take(message, now);
      if (mapper_.learn_on(now)) is_changed_ = true;
      mapper_.apply(panel_, cues_, now);
      answers = mapper_.feedback(*panel_.values(), now);
    }
    for (const auto& answer : answers) port_->send(answer);
  }

  void write_if_changed() {
    std::string text;
    {
      const std::lock_guard lock(mutex_);
      if (!std::exchange(is_changed_, false)) return;
      text = print_bindings(mapper_.bindings());
    }
    if (const auto written = write_whole(file_, text); !written)
      log::warning("midi: {}", written.error().what);
  }

  const std::string device_;
  const std::filesystem::path file_;
  Panel& panel_;
  CueDeck* cues_;
  OpenMidiPort open_;
  Complaints complaints_{"midi"};
  std::unique_ptr<Port> port_;
  std::string said_;  ///< why there is no device

  mutable std::mutex mutex_;  ///< of what follows
  Mapper mapper_;
  std::string name_;  ///< of the device; "": it is not there
  bool is_changed_ = false;

  std::mutex wait_mutex_;
  std::condition_variable_any wakes_;
  std::jthread thread_;  ///< the last member: it uses all others
};

}  // namespace
}  // namespace midi

Result<std::unique_ptr<MidiSurface>> open_midi(const config::Rig& rig,
                                               const std::filesystem::path& bindings_file,
                                               Panel& panel, CueDeck* cues,
                                               OpenMidiPort open_port) {
  if (rig.desk.midi.device.empty()) return nullptr;
  std::vector<midi::Binding> bindings;
  if (std::error_code ignored; std::filesystem::exists(bindings_file, ignored)) {
    const auto text = config::read_text(bindings_file);
    if (!text) return tl::make_unexpected(text.error());
    auto read = midi::parse_bindings(*text, bindings_file.string(), panel.controls());
    if (!read) return tl::make_unexpected(read.error());
    bindings = std::move(*read);
  }
  return std::make_unique<midi::Worker>(rig.desk.midi.device, bindings_file, std::move(bindings),
                                        panel, cues, std::move(open_port));
}

}  // namespace handcast::desk
