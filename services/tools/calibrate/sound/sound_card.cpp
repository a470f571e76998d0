// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/sound/sound_card.hpp"

#include <cstdint>
#include <utility>

#include "ipc/base/clock.hpp"
#ifdef HANDCAST_WITH_ALSA
#include <alsa/asoundlib.h>
#include <fmt/format.h>
#endif

namespace handcast::calibrate {
namespace {

/// The time of a sample by the card's clock.
std::int64_t device_ns(std::size_t sample, double rate_hz) {
  return seconds_to_ns(static_cast<double>(sample) / rate_hz);
}

}  // namespace

Recorder::Recorder(std::unique_ptr<SoundCard> card)
    : card_(std::move(card)), thread_([this](const std::stop_token& asked) { record(asked); }) {}

Recorder::~Recorder() = default;

void Recorder::record(const std::stop_token& asked) {
  constexpr double kLead_s = 2;  // what a card may have in its buffer
  const auto began_ns = now_ns();
  while (!asked.stop_requested()) {
    if (const auto read = card_->read(samples_); !read) {
      error_ = read.error();
      return;
    }
    // A block arrives when its last sample has been taken.
    clock_.add(device_ns(samples_.size(), card_->rate_hz()), now_ns());
    // A device that is not a card (ALSA's `null`) sends as fast as it is read.
    const double heard_s = static_cast<double>(samples_.size()) / card_->rate_hz();
    if (heard_s > 2 * ns_to_seconds(now_ns() - began_ns) + kLead_s) {
      error_ = Error{Errc::bad_config, "the sound device does not keep its rate; is it a card?"};
      return;
    }
  }
}

Result<calib::SoundClip> Recorder::finish() {
  thread_.request_stop();
  thread_.join();
  if (error_) return tl::make_unexpected(*error_);
  if (static_cast<double>(samples_.size()) < 0.5 * card_->rate_hz())
    return fail(Errc::bad_data, "the sound card has sent less than half a second");
  // The map is a line over the last 8 s; older samples lie on its continuation.
  const auto begin = clock_.earliest_arrival(0),
             end = clock_.earliest_arrival(device_ns(samples_.size(), card_->rate_hz()));
  const auto count = static_cast<double>(samples_.size());
  return calib::SoundClip{std::move(samples_), static_cast<double>(begin.ns),
                          static_cast<double>(end.ns - begin.ns) / count, end.error_ns};
}

#ifdef HANDCAST_WITH_ALSA
namespace {

constexpr unsigned kRate_hz = 48000, kMostChannels = 8;
constexpr snd_pcm_uframes_t kBlock = 240, kBlocks = 16;

struct ClosePcm {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};
using Pcm = std::unique_ptr<snd_pcm_t, ClosePcm>;

/// ALSA writes lines of its own to stderr otherwise.
void be_silent(const char*, int, const char*, int, const char*, ...) {}  // NOLINT(cert-dcl50-cpp)

class AlsaCard final : public SoundCard {
 public:
  AlsaCard(std::string name, Pcm pcm) : name_(std::move(name)), pcm_(std::move(pcm)) {}

  /// The format nearest to the one that is wanted. Returns what failed, or nothing.
  std::string set_format() {
    snd_pcm_hw_params_t* params = nullptr;
    snd_pcm_hw_params_alloca(&params);
    unsigned channels = 1, rate = kRate_hz;
    auto block = kBlock, buffer = kBlock * kBlocks;
    int direction = 0;
    const auto failed = [&](const char* what, int error) {
      return error < 0 ? fmt::format("{}: {}", what, snd_strerror(error)) : std::string();
    };
    for (const auto& why :
         {failed("no formats", snd_pcm_hw_params_any(pcm_.get(), params)),
          failed("blocks of samples",
                 snd_pcm_hw_params_set_access(pcm_.get(), params, SND_PCM_ACCESS_RW_INTERLEAVED)),
          failed("16 bits", snd_pcm_hw_params_set_format(pcm_.get(), params, SND_PCM_FORMAT_S16)),
          failed("channels", snd_pcm_hw_params_set_channels_near(pcm_.get(), params, &channels)),
          failed("rate", snd_pcm_hw_params_set_rate_near(pcm_.get(), params, &rate, &direction)),
          failed("length of blocks",
                 snd_pcm_hw_params_set_period_size_near(pcm_.get(), params, &block, &direction)),
          failed("length of the buffer",
                 snd_pcm_hw_params_set_buffer_size_near(pcm_.get(), params, &buffer)),
          failed("format", snd_pcm_hw_params(pcm_.get(), params)),
          failed("start", snd_pcm_start(pcm_.get()))})
      if (!why.empty()) return why;
    if (channels > kMostChannels) return fmt::format("it has {} channels", channels);
    channels_ = channels;
    rate_hz_ = rate;
    raw_.resize(block * channels);
    return {};
  }

  double rate_hz() const override { return rate_hz_; }

  Result<void> read(std::vector<float>& samples) override {
    const auto count = snd_pcm_readi(pcm_.get(), raw_.data(), raw_.size() / channels_);
    if (count == -EPIPE)
      return fail(Errc::bad_data, fmt::format("sound card '{}': samples were lost, because this "
                                              "machine is too busy; measure again",
                                              name_));
    if (count <= 0)
      return fail(Errc::disconnected,
                  fmt::format("sound card '{}': {}", name_,
                              count < 0 ? snd_strerror(static_cast<int>(count)) : "it has ended"));
    for (snd_pcm_sframes_t i = 0; i < count; ++i)
      samples.push_back(static_cast<float>(raw_[static_cast<std::size_t>(i) * channels_]) /
                        32768.0f);
    return {};
  }

 private:
  std::string name_;
  Pcm pcm_;
  unsigned channels_ = 1;
  double rate_hz_ = kRate_hz;
  std::vector<std::int16_t> raw_;  ///< one block, the channels interleaved
};

}  // namespace

Result<std::unique_ptr<SoundCard>> open_sound_card(const std::string& device) {
  snd_lib_error_set_handler(be_silent);
  snd_pcm_t* opened = nullptr;
  if (const int error = snd_pcm_open(&opened, device.c_str(), SND_PCM_STREAM_CAPTURE, 0); error < 0)
    return fail(Errc::bad_config,
                fmt::format("sound card '{}' cannot be opened ({}); `arecord -L` lists the names",
                            device, snd_strerror(error)));
  auto card = std::make_unique<AlsaCard>(device, Pcm(opened));
  if (const auto why = card->set_format(); !why.empty())
    return fail(Errc::bad_config,
                fmt::format("sound card '{}' cannot be used: {}; a name with 'plug', like "
                            "plughw:1,0, converts its format",
                            device, why));
  return card;
}
#else
Result<std::unique_ptr<SoundCard>> open_sound_card(const std::string&) {
  return fail(Errc::bad_config,
              "this build cannot read a photodiode (libasound2-dev was not found)");
}
#endif

}  // namespace handcast::calibrate
