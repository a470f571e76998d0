// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

/// Sound that content reacts to.
namespace handcast::content {

/// The newest samples of each channel that are kept: 85 ms.
inline constexpr std::size_t kHeardSamples = 4096;
/// Samples per second of each channel.
inline constexpr int kHeardRate_hz = 48000;

/// What was heard last.
struct Heard {
  /// kHeardSamples of each of the one or two channels, -1..1, the oldest first.
  std::vector<std::vector<float>> channels{std::vector<float>(kHeardSamples)};
};

/// Listens to a sound device as long as it lives. All listeners of a process share one thread,
/// which holds the device only while there are some, and the device of the newest of them. One that
/// is missing, or stalls, is silent and named in the log, and is tried again each second.
class SoundListener {
 public:
  /// `device`: its ALSA name. Does not wait for it.
  explicit SoundListener(std::string device);
  SoundListener(const SoundListener&) = delete;
  SoundListener& operator=(const SoundListener&) = delete;
  ~SoundListener();

  /// Does not wait; zeros if nothing was heard for a while.
  Heard newest() const;
};

/// Sound as an image for shaders: a row per channel, the first one first.
struct SoundImage {
  int width = 0, height = 0;
  std::vector<float> levels;
};

/// The newest samples, 0..1; silence is 0.5. `width`: of the image, 1 to kHeardSamples.
SoundImage waveform_of(const Heard& heard, int width);

/// Computes the levels of frequencies. One thread.
class Spectrum {
 public:
  static constexpr int kBins = 1024;  ///< from 0 Hz to half the rate of the samples

  Spectrum();
  Spectrum(const Spectrum&) = delete;
  Spectrum& operator=(const Spectrum&) = delete;
  ~Spectrum();

  /// The amplitudes of all kBins of one channel: 1 is a sine of full scale. Valid until the next
  /// call.
  const std::vector<float>& amplitudes(const std::vector<float>& samples);
  /// The amplitudes as an image of `width` columns, 1 to 4096, each the largest of its bins.
  SoundImage image_of(const Heard& heard, int width);
  /// As Shadertoy and the Web Audio API have it: 512 columns; row 0 is the lower half of the
  /// spectrum, -100 to -30 dB as 0..1, and row 1 the newest samples. Of the mean of the channels.
  SoundImage shadertoy_image_of(const Heard& heard);

 private:
  struct Transform;
  std::unique_ptr<Transform> transform_;
  std::vector<float> amplitudes_;
};

}  // namespace handcast::content
