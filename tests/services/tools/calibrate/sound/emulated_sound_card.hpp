// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"

namespace handcast::test {

/// A sound card below ALSA's library: its plugin `file` reads what is recorded from a pipe, into
/// which a thread writes 16-bit samples after their times, in blocks of 5 ms, from the moment at
/// which the card is opened, by this process or by another one. ALSA_CONFIG_PATH and the name
/// "photodiode" lead to it.
class EmulatedSoundCard {
 public:
  static constexpr double kRate_hz = 48000;
  static constexpr int kBlock = 240;

  /// `voltage`: -1..1 at a time of CLOCK_MONOTONIC that is over; called by the thread. `drift`: how
  /// much faster the card's clock runs.
  explicit EmulatedSoundCard(std::function<double(std::int64_t time_ns)> voltage, double drift = 0)
      : voltage_(std::move(voltage)), rate_hz_(kRate_hz * (1 + drift)) {
    const std::string pipe = scratch_.path() / "samples", file = scratch_.path() / "asound.conf";
    mkfifo(pipe.c_str(), 0600);
    ::signal(SIGPIPE, SIG_IGN);
    std::ofstream(file) << "pcm.silence { type null }\npcm.photodiode {\n  type file\n  slave.pcm "
                           "silence\n  file /dev/null\n  infile \""
                        << pipe << "\"\n  format raw\n}\n";
    ::setenv("ALSA_CONFIG_PATH", file.c_str(), 1);
    thread_ = std::jthread([this](const std::stop_token& asked) { play(asked); });
  }
  ~EmulatedSoundCard() {
    thread_.request_stop();
    thread_.join();
    ::unsetenv("ALSA_CONFIG_PATH");
  }
  EmulatedSoundCard(const EmulatedSoundCard&) = delete;
  EmulatedSoundCard& operator=(const EmulatedSoundCard&) = delete;

 private:
  void play(const std::stop_token& asked) {
    const int pipe = wait_for_reader(asked);
    if (pipe < 0) return;
    const auto begin_ns = now_ns();
    const auto time_of = [&](long sample) {
      return begin_ns + seconds_to_ns(static_cast<double>(sample) / rate_hz_);
    };
    std::vector<std::int16_t> block(kBlock);
    for (long first = 0; !asked.stop_requested(); first += kBlock) {
      sleep_until_ns(time_of(first + kBlock));
      for (int i = 0; i < kBlock; ++i)
        block[static_cast<std::size_t>(i)] =
            static_cast<std::int16_t>(std::lround(32767 * voltage_(time_of(first + i))));
      // Whole blocks, which are small enough: a full pipe takes none (EAGAIN).
      while (::write(pipe, block.data(), 2 * block.size()) < 0) {
        if (errno != EAGAIN || asked.stop_requested()) break;
        sleep_until_ns(now_ns() + 1'000'000);
      }
    }
    ::close(pipe);
  }

  /// The writing end; -1 if the card was never opened.
  int wait_for_reader(const std::stop_token& asked) const {
    const std::string pipe = scratch_.path() / "samples";
    while (!asked.stop_requested()) {
      if (const int end = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC); end >= 0)
        return end;
      sleep_until_ns(now_ns() + 1'000'000);
    }
    return -1;
  }

  Scratch scratch_;
  std::function<double(std::int64_t)> voltage_;
  double rate_hz_;
  std::jthread thread_;
};

}  // namespace handcast::test
