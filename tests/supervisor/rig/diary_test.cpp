// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/diary.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

Figures camera_at(double held_hz) {
  Figures figures;
  figures.streams["camera.frames"] = {
      .wanted_hz = 100, .held_hz = held_hz, .is_held_to_it = true, .is_settled = true};
  return figures;
}

/// A diary of a rig, on a clock of the test's own, that is looked at as the supervisor does.
struct Watched {
  Diary diary;
  std::int64_t now_ns = kSecond_ns;

  std::vector<std::string> run(double seconds, double held_hz) {
    std::vector<std::string> texts;
    for (const auto end_ns = now_ns + static_cast<std::int64_t>(seconds * 1e9); now_ns < end_ns;
         now_ns += Diary::kLook_ns)
      for (auto& entry : diary.look(now_ns, camera_at(held_hz), "summary"))
        texts.push_back(std::move(entry.text));
    return texts;
  }
};

TEST(Diary, ADayWithoutChangesIsASummaryAnHour) {
  Watched rig;
  EXPECT_THAT(rig.run(24 * 3600, 100), testing::AllOf(SizeIs(24), testing::Each("summary")));
}

TEST(Diary, AStreamThatIsSlowForAWhileIsNamedOnceAndSoIsItsReturn) {
  Watched rig;
  rig.run(60, 100);
  EXPECT_THAT(rig.run(600, 40), ElementsAre(HasSubstr("camera.frames is slow: 40 Hz of 100 Hz")));
  EXPECT_THAT(rig.run(600, 99), ElementsAre(HasSubstr("camera.frames holds its rate again")));
}

TEST(Diary, AStreamThatWaversIsNoChange) {
  Watched rig;
  rig.run(60, 100);
  for (int i = 0; i < 50; ++i) EXPECT_THAT(rig.run(10, i % 2 ? 85 : 95), IsEmpty());
}

TEST(Diary, AServiceThatHasJustStartedIsNotJudged) {
  Diary diary;
  auto figures = camera_at(10);
  figures.streams["camera.frames"].is_settled = false;
  diary.look(0, figures, "summary");
  for (int i = 1; i < 60; ++i) EXPECT_THAT(diary.look(i * kSecond_ns, figures, ""), IsEmpty());
}

}  // namespace
}  // namespace handcast::supervisor
