// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <RtMidi.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"

extern char** environ;

namespace handcast::test {

/// A JACK server of its own, which has no sound card. Programs find it while it lives.
class JackServer {
 public:
  JackServer() {
    if (std::system("command -v jackd >/dev/null") != 0) return;
    ::setenv("JACK_DEFAULT_SERVER", name_.c_str(), 1);
    std::string command =
        "exec timeout 90 jackd -n " + name_ + " -r -d dummy -p 256 >/dev/null 2>&1";
    char* const arguments[] = {const_cast<char*>("sh"), const_cast<char*>("-c"), command.data(),
                               nullptr};
    if (::posix_spawn(&pid_, "/bin/sh", nullptr, nullptr, arguments, environ) != 0) return;
    const auto socket = fmt::format("/dev/shm/jack-{}/{}/jack_0", ::getuid(), name_);
    for (const auto end = Deadline::in(std::chrono::seconds(20)); !works_ && !end.passed();) {
      works_ = std::filesystem::exists(socket);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(works_) << socket;
  }
  JackServer(const JackServer&) = delete;
  JackServer& operator=(const JackServer&) = delete;
  ~JackServer() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  /// False if there is no server on this machine; why() says why.
  explicit operator bool() const { return works_; }
  static std::string why() { return "jackd is not installed (jackd1)"; }

 private:
  std::string name_ = fmt::format("handcast-test-{}", ::getpid());
  pid_t pid_ = -1;
  bool works_ = false;
};

/// A MIDI controller with motors, "Emulated Fader": virtual ports of this process.
class EmulatedController {
 public:
  explicit EmulatedController(RtMidi::Api api)
      : out_(api, "Emulated Fader"), in_(api, "Emulated Fader") {
    in_.setCallback(
        [](double, std::vector<unsigned char>* message, void* self) {
          auto& controller = *static_cast<EmulatedController*>(self);
          const std::lock_guard lock(controller.mutex_);
          controller.shown_.push_back(*message);
        },
        this);
    out_.openVirtualPort("moved");
    in_.openVirtualPort("shown");
  }
  void move(const std::vector<unsigned char>& message) { out_.sendMessage(&message); }
  bool has_shown(const std::vector<unsigned char>& message) {
    const std::lock_guard lock(mutex_);
    return std::ranges::find(shown_, message) != shown_.end();
  }

 private:
  std::mutex mutex_;
  std::vector<std::vector<unsigned char>> shown_;
  RtMidiOut out_;
  RtMidiIn in_;
};

}  // namespace handcast::test
