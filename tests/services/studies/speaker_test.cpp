// SPDX-License-Identifier: Apache-2.0
// Against the real library of ALSA.
#include "services/studies/shooter/speaker.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"

namespace handcast::study {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Sound devices of ALSA's own plugins: "out" writes to a file, "hung" does not come back from
/// being opened. They live as long as the process, as the threads of speakers do.
class SoundFile {
 public:
  static SoundFile& of_process() {
    static auto& file = *new SoundFile;
    return file;
  }
  std::vector<std::int16_t> samples() const {
    std::ifstream file(folder_.path() / "out", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    std::vector<std::int16_t> samples(bytes.size() / 2);
    std::copy_n(bytes.data(), 2 * samples.size(), reinterpret_cast<char*>(samples.data()));
    return samples;
  }

 private:
  SoundFile() {
    const auto config = (folder_.path() / "asound.conf").string();
    ::mkfifo((folder_.path() / "pipe").c_str(), 0600);
    std::ofstream text(config);
    text << "pcm.silence { type null }\n";
    for (const auto& [name, file] : {std::pair("out", "out"), {"hung", "pipe"}})
      text << "pcm." << name << " { type file slave.pcm silence format raw file \""
           << (folder_.path() / file).string() << "\" }\n";
    ::setenv("ALSA_CONFIG_PATH", config.c_str(), 1);
  }
  test::Scratch folder_;
};

template <class Condition>
bool comes_true(Condition condition) {
  for (const auto until = Deadline::in(20s); !until.passed(); std::this_thread::sleep_for(5ms))
    if (condition()) return true;
  return false;
}

/// How often the sign changes in a second of a sound's loud part.
double crossings_hz(const std::vector<float>& samples) {
  int count = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) count += samples[i - 1] * samples[i] < 0;
  return 0.5 * count * kSoundRate_hz / static_cast<double>(samples.size());
}

TEST(ShooterSounds, AreShortNotTooLoudAndDiffer) {
  for (const auto sound : {ShooterSound::shot, ShooterSound::hit, ShooterSound::loss}) {
    const auto& samples = samples_of(sound);
    EXPECT_LE(samples.size(), 1.0 * kSoundRate_hz);
    for (const float sample : samples) EXPECT_LE(std::abs(sample), 0.3f);
  }
  EXPECT_GT(crossings_hz(samples_of(ShooterSound::shot)), 700);
  EXPECT_LT(crossings_hz(samples_of(ShooterSound::hit)), 300);
  EXPECT_LT(crossings_hz(samples_of(ShooterSound::loss)), 180);
}

TEST(ShooterSounds, AreHeardWhenSomethingHappensAndNotBefore) {
  auto& file = SoundFile::of_process();
  ShooterSpeaker speaker("out");
  ASSERT_TRUE(comes_true([&] { return file.samples().size() > 5000; }));
  const auto is_silent = [](const auto& samples) {
    return std::ranges::all_of(samples, [](auto sample) { return sample == 0; });
  };
  EXPECT_TRUE(is_silent(file.samples()));
  speaker.play({.has_shot = true});
  EXPECT_TRUE(comes_true([&] { return !is_silent(file.samples()); }));
  const auto loudest = [&] {
    const auto samples = file.samples();
    return std::ranges::max(samples);
  };
  EXPECT_TRUE(comes_true([&] { return loudest() > 5000; })) << loudest();
  // As fast as the clock, whatever the device would take.
  EXPECT_LT(file.samples().size(), 30u * kSoundRate_hz);
}

TEST(ShooterSounds, ADeviceThatIsMissingOrHangsIsNamedAndTheGameGoesOn) {
  SoundFile::of_process();
  testing::internal::CaptureStderr();
  ShooterSpeaker missing("missing"), hung("hung"), none("");
  const auto begin_ns = now_ns();
  for (const auto end = Deadline::in(3s); !end.passed(); std::this_thread::sleep_for(10ms))
    for (auto* speaker : {&missing, &hung, &none}) speaker->play({true, true, true});
  const auto said = testing::internal::GetCapturedStderr();
  EXPECT_GT(now_ns(), begin_ns);
  EXPECT_THAT(said, HasSubstr("sound device 'missing' cannot be opened"));
  EXPECT_THAT(said, HasSubstr("sound device 'hung' hangs"));
  EXPECT_EQ(said.find("'missing'"), said.rfind("'missing'")) << "once";
}

}  // namespace
}  // namespace handcast::study
