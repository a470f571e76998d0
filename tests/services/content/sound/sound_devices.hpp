// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "tests/scratch.hpp"

namespace handcast::test {

/// Sound devices of ALSA's own plugins, which ALSA_CONFIG_PATH leads to: "silence"; "tone", with a
/// sine of kLeft_hz and amplitude 0.5 on the left and one of kRight_hz and 0.25 on the right;
/// "hung", which does not come back from being opened until release(). There is no "missing".
class SoundDevices {
 public:
  /// In the middle of bins 44 and 128 of 1024.
  static constexpr double kLeft_hz = 44 * 48000. / 2048, kRight_hz = 128 * 48000. / 2048;

  SoundDevices() {
    std::vector<std::int16_t> samples;
    for (int i = 0; i < 2048 * 100; ++i)
      for (const auto& [hz, amplitude] : {std::pair(kLeft_hz, 0.5), std::pair(kRight_hz, 0.25)})
        samples.push_back(static_cast<std::int16_t>(
            std::lround(32767 * amplitude * std::sin(2 * std::numbers::pi * hz * i / 48000))));
    std::ofstream(scratch_.path() / "tone", std::ios::binary)
        .write(reinterpret_cast<const char*>(samples.data()),
               static_cast<std::streamsize>(2 * samples.size()));
    ::mkfifo((scratch_.path() / "pipe").c_str(), 0600);
    std::ofstream(config_) << "pcm.silence { type null }\n";
    add("tone", "tone");
    add("hung", "pipe");
    ::setenv("ALSA_CONFIG_PATH", config_.c_str(), 1);
  }
  SoundDevices(const SoundDevices&) = delete;
  SoundDevices& operator=(const SoundDevices&) = delete;
  ~SoundDevices() { ::unsetenv("ALSA_CONFIG_PATH"); }

  /// Adds a device that plays the file "tone" or the pipe.
  void add(const std::string& name, const std::string& file) const {
    std::ofstream(config_, std::ios::app)
        << "pcm." << name << " { type file slave.pcm silence file /dev/null format raw infile \""
        << (scratch_.path() / file).string() << "\" }\n";
  }
  /// Lets "hung" be opened, and end.
  void release() const {
    ::close(::open((scratch_.path() / "pipe").c_str(), O_WRONLY | O_CLOEXEC));
  }

 private:
  Scratch scratch_;
  std::string config_ = (scratch_.path() / "asound.conf").string();
};

}  // namespace handcast::test
