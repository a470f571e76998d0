// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"
#include "services/content/sound/sound.hpp"
#ifdef HANDCAST_WITH_ALSA
#include <alsa/asoundlib.h>
#endif

namespace handcast::content {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 5ms, kRetry = 1000ms;
/// After which a device counts as silent, and as one that stalls.
constexpr std::int64_t kSilent_ns = 300'000'000, kStalled_ns = 2'000'000'000;

#ifdef HANDCAST_WITH_ALSA
struct ClosePcm {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};

/// ALSA writes lines of its own to stderr otherwise.
void be_silent(const char*, int, const char*, int, const char*, ...) {}  // NOLINT(cert-dcl50-cpp)

/// The input of a sound card, or of PipeWire or PulseAudio by their plugins. One thread.
class SoundDevice {
 public:
  /// Errors (unavailable): there is none of this name, it is in use, or it cannot record.
  static Result<SoundDevice> open(const std::string& name) {
    snd_lib_error_set_handler(be_silent);
    snd_pcm_t* opened = nullptr;
    int error = snd_pcm_open(&opened, name.c_str(), SND_PCM_STREAM_CAPTURE, SND_PCM_NONBLOCK);
    if (error < 0)
      return fail(Errc::unavailable,
                  fmt::format("cannot be opened ({}); `arecord -L` lists the names for "
                              "content.sound",
                              snd_strerror(error)));
    SoundDevice device(opened);
    for (device.channels_ = 2; device.channels_ > 0; --device.channels_) {
      error = snd_pcm_set_params(opened, SND_PCM_FORMAT_S16, SND_PCM_ACCESS_RW_INTERLEAVED,
                                 device.channels_, kHeardRate_hz, 1, 100'000);
      if (error == 0) error = snd_pcm_start(opened);
      if (error == 0) return device;
    }
    return fail(Errc::unavailable, fmt::format("cannot record 16 bits at 48 kHz ({}); a name "
                                               "with 'plug', like plughw:1,0, converts its format",
                                               snd_strerror(error)));
  }

  /// The samples that have come, the channels interleaved; does not wait. Errors (disconnected): it
  /// is gone.
  Result<std::vector<std::int16_t>> read() {
    std::vector<std::int16_t> samples(kHeardSamples * channels_);
    auto count = snd_pcm_readi(pcm_.get(), samples.data(), kHeardSamples);
    // Samples were lost, or the machine has slept.
    if (count == -EPIPE || count == -ESTRPIPE) {
      count = snd_pcm_recover(pcm_.get(), static_cast<int>(count), 1);
      if (count == 0) count = snd_pcm_start(pcm_.get());
    }
    if (count == -EAGAIN) count = 0;
    if (count < 0)
      return fail(Errc::disconnected,
                  fmt::format("has ended ({})", snd_strerror(static_cast<int>(count))));
    samples.resize(static_cast<std::size_t>(count) * channels_);
    return samples;
  }
  unsigned channels() const { return channels_; }

 private:
  explicit SoundDevice(snd_pcm_t* pcm) : pcm_(pcm) {}

  std::unique_ptr<snd_pcm_t, ClosePcm> pcm_;
  unsigned channels_ = 0;
};
#else
struct SoundDevice {
  static Result<SoundDevice> open(const std::string&) {
    return fail(Errc::unavailable,
                "cannot be opened: this build has no ALSA (libasound2-dev was not found)");
  }
  Result<std::vector<std::int16_t>> read() { return {}; }
  unsigned channels() const { return 1; }
};
#endif

/// The thread that listens, and what it has heard. It lives as long as the process: a device may
/// hang while it is opened.
class Ear {
 public:
  static Ear& of_process() {
    static Ear& ear = *new Ear;
    return ear;
  }

  void begin(std::string device) {
    const std::scoped_lock lock(mutex_);
    if (device_ != device) told_.clear();
    device_ = std::move(device);
    if (listeners_++ == 0) heard_ns_ = now_ns() - kSilent_ns;
    if (!std::exchange(has_thread_, true)) std::thread([this] { run(); }).detach();
    changed_.notify_all();
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    --listeners_;
    changed_.notify_all();
  }
  Heard newest() {
    bool is_stalled = false;
    Heard heard;
    {
      const std::scoped_lock lock(mutex_);
      const auto quiet_ns = now_ns() - heard_ns_;
      if (quiet_ns < kSilent_ns) heard = heard_;
      is_stalled = quiet_ns > kStalled_ns;
    }
    // The thread itself may hang.
    if (is_stalled) tell("gives no sound");
    return heard;
  }

 private:
  void run() {
    for (std::string device;;) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return listeners_ > 0; });
        device = device_;
      }
      auto opened = SoundDevice::open(device);
      if (opened)
        listen(*opened, device);
      else
        tell(opened.error().what);
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kRetry, [&] { return listeners_ == 0 || device_ != device; });
    }
  }

  /// Until it fails, or nobody listens to it.
  void listen(SoundDevice& device, const std::string& name) {
    auto last_ns = now_ns();
    while (is_wanted(name)) {
      const auto samples = device.read();
      if (!samples) return tell(samples.error().what);
      if (!samples->empty()) last_ns = now_ns(), keep(*samples, device.channels());
      if (now_ns() - last_ns > kStalled_ns) return tell("gives no sound");
      // ALSA's `null` and `file` would give samples as fast as they are read.
      std::this_thread::sleep_for(kPause);
    }
  }

  bool is_wanted(const std::string& device) {
    const std::scoped_lock lock(mutex_);
    return listeners_ > 0 && device_ == device;
  }

  void keep(const std::vector<std::int16_t>& samples, unsigned channels) {
    const std::scoped_lock lock(mutex_);
    heard_.channels.resize(channels, std::vector<float>(kHeardSamples));
    for (unsigned channel = 0; channel < channels; ++channel) {
      auto& kept = heard_.channels[channel];
      for (auto i = channel; i < samples.size(); i += channels)
        kept.push_back(static_cast<float>(samples[i]) / 32768);
      kept.erase(kept.begin(), kept.end() - kHeardSamples);
    }
    heard_ns_ = now_ns();
    if (!told_.empty()) log::info("content hears sound device '{}'", device_);
    told_.clear();
  }

  /// Says once why there is silence.
  void tell(const std::string& why) {
    const std::scoped_lock lock(mutex_);
    if (!told_.empty() || listeners_ == 0) return;
    told_ = why;
    log::warning("content hears silence, because sound device '{}' {}", device_, why);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_thread_ = false;
  int listeners_ = 0;
  std::string device_, told_;
  Heard heard_;
  std::int64_t heard_ns_ = 0;  ///< when
};

}  // namespace

SoundListener::SoundListener(std::string device) { Ear::of_process().begin(std::move(device)); }
SoundListener::~SoundListener() { Ear::of_process().end(); }
Heard SoundListener::newest() const { return Ear::of_process().newest(); }

}  // namespace handcast::content
