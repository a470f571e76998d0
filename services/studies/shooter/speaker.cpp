// SPDX-License-Identifier: Apache-2.0
#include "services/studies/shooter/speaker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numbers>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"
#ifdef HANDCAST_WITH_ALSA
#include <alsa/asoundlib.h>
#endif

namespace handcast::study {
namespace {

constexpr auto kPause = std::chrono::milliseconds(5), kRetry = std::chrono::milliseconds(1000);
constexpr double kLead_s = 0.04;  ///< so far ahead of the clock samples are written
constexpr std::int64_t kHangs_ns = 2'000'000'000;

/// A tone that glides from one frequency to another and dies away. `edge`: 0 a sine, 1 a square.
std::vector<float> glide(double from_hz, double to_hz, double seconds, double edge) {
  std::vector<float> samples(static_cast<std::size_t>(seconds * kSoundRate_hz));
  double phase = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(samples.size());
    phase += 2 * std::numbers::pi * from_hz * std::pow(to_hz / from_hz, part) / kSoundRate_hz;
    const double sine = std::sin(phase), square = sine < 0 ? -1 : 1;
    samples[i] = static_cast<float>(0.3 * (1 - part) * (1 - part) * std::lerp(sine, square, edge));
  }
  return samples;
}

#ifdef HANDCAST_WITH_ALSA
struct CloseOutput {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};

/// ALSA writes lines of its own to stderr otherwise.
void say_nothing(const char*, int, const char*, int, const char*, ...) {}  // NOLINT(cert-dcl50-cpp)

/// The output of a sound card. One thread.
class SoundOutput {
 public:
  static Result<SoundOutput> open(const std::string& name) {
    snd_lib_error_set_handler(say_nothing);
    snd_pcm_t* opened = nullptr;
    int error = snd_pcm_open(&opened, name.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (error < 0)
      return fail(Errc::unavailable, fmt::format("cannot be opened ({}); `aplay -L` lists names",
                                                 snd_strerror(error)));
    SoundOutput output(opened);
    error = snd_pcm_set_params(opened, SND_PCM_FORMAT_S16, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                               kSoundRate_hz, 1, 100'000);
    if (error == 0) return output;
    return fail(Errc::unavailable,
                fmt::format("cannot play 16 bits at 48 kHz ({})", snd_strerror(error)));
  }
  /// Writes what it takes at once. Returns how many samples. Errors (disconnected): it is gone.
  Result<std::size_t> write(const std::vector<std::int16_t>& samples) {
    auto count = snd_pcm_writei(pcm_.get(), samples.data(), samples.size());
    if (count == -EPIPE || count == -ESTRPIPE)
      count = snd_pcm_recover(pcm_.get(), static_cast<int>(count), 1);
    if (count == -EAGAIN) count = 0;
    if (count >= 0) return static_cast<std::size_t>(count);
    return fail(Errc::disconnected,
                fmt::format("has ended ({})", snd_strerror(static_cast<int>(count))));
  }

 private:
  explicit SoundOutput(snd_pcm_t* pcm) : pcm_(pcm) {}
  std::unique_ptr<snd_pcm_t, CloseOutput> pcm_;
};
#else
struct SoundOutput {
  static Result<SoundOutput> open(const std::string&) {
    return fail(Errc::unavailable,
                "cannot be opened: this build has no ALSA (libasound2-dev was not found)");
  }
  Result<std::size_t> write(const std::vector<std::int16_t>& samples) { return samples.size(); }
};
#endif

}  // namespace

const std::vector<float>& samples_of(ShooterSound sound) {
  static const std::array all{glide(1400, 500, 0.09, 0), glide(420, 110, 0.16, 0.6),
                              glide(300, 55, 0.7, 0.4)};
  return all[static_cast<std::size_t>(sound)];
}

/// The thread that plays, and what it is to play.
class ShooterSpeaker::Voice {
 public:
  explicit Voice(std::string device) : device_(std::move(device)) {
    std::thread([this] { run(); }).detach();
  }
  void play(ShooterSound sound) {
    {
      const std::scoped_lock lock(mutex_);
      constexpr std::size_t kMostAtOnce = 8;
      if (playing_.size() < kMostAtOnce) playing_.push_back({&samples_of(sound), 0});
    }
    if (now_ns() - worked_ns_ > kHangs_ns) tell("hangs");
  }

 private:
  /// A sound, and how much of it was played.
  struct Playing {
    const std::vector<float>* samples;
    std::size_t next;
  };

  void run() {
    for (;; std::this_thread::sleep_for(kRetry)) {
      auto output = SoundOutput::open(device_);
      worked_ns_ = now_ns();
      const auto ended = output ? play_on(*output) : tl::make_unexpected(output.error());
      tell(ended.error().what);
    }
  }

  /// Plays until the device is gone.
  Result<void> play_on(SoundOutput& output) {
    const auto begin_ns = now_ns();
    std::size_t written = 0;
    std::vector<std::int16_t> waiting;
    for (;; std::this_thread::sleep_for(kPause)) {
      worked_ns_ = now_ns();
      // ALSA's `null` and `file` would take samples as fast as they are written.
      const auto due =
          static_cast<std::size_t>((ns_to_seconds(now_ns() - begin_ns) + kLead_s) * kSoundRate_hz);
      while (written + waiting.size() < due) waiting.push_back(next_sample());
      const auto count = output.write(waiting);
      if (!count) return tl::make_unexpected(count.error());
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(*count));
      written += *count;
    }
  }

  std::int16_t next_sample() {
    const std::scoped_lock lock(mutex_);
    float sum = 0;
    for (auto& [samples, next] : playing_) sum += (*samples)[next++];
    std::erase_if(playing_, [](const auto& each) { return each.next == each.samples->size(); });
    return static_cast<std::int16_t>(std::lround(32767 * std::clamp(sum, -1.f, 1.f)));
  }

  void tell(const std::string& why) {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(told_, why) != why)
      log::warning("the game is silent, because sound device '{}' {}", device_, why);
  }

  const std::string device_;
  std::mutex mutex_;  ///< of what follows
  std::vector<Playing> playing_;
  std::string told_;
  std::atomic<std::int64_t> worked_ns_ = now_ns();
};

ShooterSpeaker::ShooterSpeaker(const std::string& device) {
  if (!device.empty()) voice_ = new Voice(device);
}

void ShooterSpeaker::play(const ShooterEvents& events) {
  if (!voice_) return;
  if (events.has_shot) voice_->play(ShooterSound::shot);
  if (events.has_hit) voice_->play(ShooterSound::hit);
  if (events.has_lost) voice_->play(ShooterSound::loss);
}

}  // namespace handcast::study
