// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/inbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/services/desk/osc/packets.hpp"
#include "tests/services/desk/recorded_cues.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk::osc {
namespace {

using test::bundle_at;
using test::bytes_of;
using test::kSecond_ns;
using test::packet;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using namespace std::string_literals;

constexpr std::int64_t kWall_ns = 1'700'000'000 * kSecond_ns;

/// The NTP time of a wall clock.
std::uint64_t tag_of(std::int64_t wall_ns) {
  return static_cast<std::uint64_t>(wall_ns / kSecond_ns + 2'208'988'800) << 32 |
         static_cast<std::uint64_t>((wall_ns % kSecond_ns << 32) / kSecond_ns);
}

class OscInbox : public testing::Test {
 protected:
  Instant at(std::int64_t after_ns) const { return {kSecond_ns + after_ns, kWall_ns + after_ns}; }
  void take(const std::string& bytes, std::int64_t after_ns = 0) {
    inbox.take(bytes_of(bytes), "10.0.0.7", at(after_ns));
  }
  void apply(std::int64_t after_ns = 0) { inbox.apply(panel, &cues, at(after_ns)); }
  /// What is said of a packet.
  std::string fault_of(const std::string& bytes) {
    said.clear();
    time_ns += 2 * kSecond_ns;
    inbox.take_due(at(time_ns));
    take(bytes, time_ns);
    apply(time_ns);
    return said.empty() ? "" : said.back();
  }

  test::TablePanel panel;
  test::RecordedCues cues;
  std::vector<std::string> said;
  Addresses addresses{panel.controls()};
  Complaints complaints{"osc", [this](const std::string& line) { said.push_back(line); }};
  Inbox inbox{addresses, complaints};
  std::int64_t time_ns = 0;

  void SetUp() override { inbox.take_due(at(0)); }
};

TEST_F(OscInbox, AMessageSetsTheSettingOfItsAddress) {
  take(packet("/projector/brightness", 0.5f));
  apply();
  EXPECT_EQ(panel.value("projector.brightness"), "0.5");
  EXPECT_EQ(panel.source(), "osc 10.0.0.7");
}

TEST_F(OscInbox, EveryKindOfSettingTakesItsTypes) {
  for (const auto& bytes :
       {packet("/light/blackout", true), packet("/light/freeze", std::int32_t{1}),
        packet("/projector/fill/cells", 12.f), packet("/light/master", std::int32_t{0}),
        packet("/cascade/predict/method", "velocity"), packet("/content/gravity", 0.f, 0.f, 1.f),
        packet("/light/keep_out", "0 0, 9 0, 9 9", "1 1, 2 1, 2 2")})
    take(bytes);
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true");
  EXPECT_EQ(panel.value("light.freeze"), "true");
  EXPECT_EQ(panel.value("projector.fill.cells"), "12");
  EXPECT_EQ(panel.value("light.master"), "0");
  EXPECT_EQ(panel.value("cascade.predict.method"), "\"velocity\"");
  EXPECT_EQ(panel.value("content.gravity"), "[0, 0, 1]");
  EXPECT_EQ(panel.value("light.keep_out"), "[\"0 0, 9 0, 9 9\", \"1 1, 2 1, 2 2\"]");
  EXPECT_EQ(complaints.count(), 0u);

  take(packet("/cascade/predict/method", std::int32_t{2}));
  take(packet("/light/blackout", false));
  take("/light/freeze\0\0\0,N\0\0"s);
  apply();
  EXPECT_EQ(panel.value("cascade.predict.method"), "\"acceleration\"");
  EXPECT_EQ(panel.value("light.blackout"), "false");
  EXPECT_EQ(panel.value("light.freeze"), "false") << "as in the rig file";
}

TEST_F(OscInbox, AFloatIsTheShortestNumberThatItStandsFor) {
  take(packet("/light/master", 0.1f));
  apply();
  EXPECT_EQ(panel.value("light.master"), "0.1");
}

TEST_F(OscInbox, OnlyTheNewestValueOfAControlIsKept) {
  for (int i = 0; i <= 100'000; ++i)
    take(packet("/projector/brightness", static_cast<float>(i) / 100'000));
  take(packet("/light/master", 0.25f));
  apply();
  EXPECT_THAT(panel.sets, ElementsAre(ElementsAre("projector.brightness=1", "light.master=0.25")));
}

TEST_F(OscInbox, BadMessagesAreNamed) {
  EXPECT_THAT(fault_of(packet("/projector/brigthness", 0.5f)), HasSubstr("there is no address"));
  EXPECT_THAT(fault_of(packet("/projector/brightness", 1.5f)), HasSubstr("1.5 is outside 0..1"));
  EXPECT_THAT(fault_of(packet("/projector/brightness", std::numeric_limits<float>::quiet_NaN())),
              HasSubstr("outside"));
  EXPECT_THAT(fault_of(packet("/projector/brightness", "much")), HasSubstr("'much' is a text"));
  EXPECT_THAT(fault_of(packet("/projector/brightness")), HasSubstr("has 0 arguments"));
  EXPECT_THAT(fault_of(packet("/projector/fill/cells", 2.5f)), HasSubstr("no whole number"));
  EXPECT_THAT(fault_of(packet("/cascade/predict/method", "velocitty")),
              HasSubstr("did you mean 'velocity'"));
  EXPECT_THAT(fault_of(packet("/cascade/predict/method", std::int32_t{7})), HasSubstr("0..2"));
  EXPECT_THAT(fault_of(packet("/light/keep_out", 1.f)), HasSubstr("takes texts"));
  EXPECT_THAT(fault_of(packet("/content/gravity", 1.f)), HasSubstr("list of 3 numbers"));
  EXPECT_THAT(fault_of(packet("/content/left", 1.f)), HasSubstr("takes one text"));
  EXPECT_THAT(fault_of(packet("/preset/none")), HasSubstr("there is no preset"));
  EXPECT_THAT(fault_of(packet("/cue/run")), HasSubstr("/cue/go"));
  EXPECT_THAT(fault_of(packet(std::string(300, '/'))), HasSubstr("255 bytes"));
  EXPECT_EQ(complaints.count(), 14u);
  EXPECT_EQ(panel.values()->revision, test::TablePanel().values()->revision) << "nothing changed";
}

TEST_F(OscInbox, AFloodOfFaultsIsOneLineASecond) {
  for (int i = 0; i < 100'000; ++i) take(packet("/no/such", 1.f), std::int64_t{i} * 30'000);
  EXPECT_THAT(said, SizeIs(3));
  EXPECT_EQ(complaints.count(), 100'000u);
  EXPECT_THAT(said.back(), HasSubstr("other faults since"));
}

TEST_F(OscInbox, OneThatTheRigRefusesDoesNotCostTheOthers) {
  take(packet("/content/gravity", 1.f));  // a list of another length: only the rig knows
  take(packet("/light/master", 0.25f));
  apply();
  EXPECT_EQ(panel.value("light.master"), "0.25");
  EXPECT_EQ(complaints.count(), 1u);
}

TEST_F(OscInbox, ContentIsShown) {
  take(packet("/content/left", "tiger"));
  take(packet("/content/left", "zebra"));
  apply();
  EXPECT_THAT(panel.shown, ElementsAre(std::pair("left"s, "zebra"s)));
}

TEST_F(OscInbox, CommandsAreObeyedInTheirOrderAndNotWhenAButtonIsReleased) {
  ASSERT_TRUE(panel.store("evening"));
  for (const auto& bytes :
       {packet("/cue/go", 1.f), packet("/cue/go", 0.f), packet("/cue/back"),
        packet("/cue/hold", true), packet("/cue/jump", "finale"),
        packet("/cue/jump", std::int32_t{3}), packet("/cue/key", "g"), packet("/preset/evening")})
    take(bytes);
  apply();
  EXPECT_THAT(cues.calls, ElementsAre("go", "back", "hold", "jump finale", "jump 3", "key g"));
  EXPECT_THAT(panel.loads, ElementsAre("evening"));
  EXPECT_EQ(complaints.count(), 0u);
}

TEST_F(OscInbox, CommandsAreBounded) {
  for (int i = 0; i < 1000; ++i) take(packet("/cue/go"));
  apply();
  EXPECT_THAT(cues.calls, SizeIs(32));
  EXPECT_EQ(complaints.count(), 968u);
}

TEST_F(OscInbox, WithoutCuesACommandOfThemIsAFault) {
  take(packet("/cue/go"));
  inbox.apply(panel, nullptr, at(0));
  EXPECT_THAT(said, ElementsAre(HasSubstr("there is no cue list")));
}

TEST_F(OscInbox, ABundleIsOneChange) {
  take(write_bundle(
      std::vector{packet("/projector/brightness", 0.5f), packet("/light/master", 0.25f)}));
  apply();
  EXPECT_THAT(panel.sets, ElementsAre(SizeIs(2)));
}

TEST_F(OscInbox, ABundleWaitsForItsTime) {
  const std::vector parts{packet("/projector/brightness", 0.5f)};
  take(bundle_at(tag_of(kWall_ns + kSecond_ns / 2), parts));
  EXPECT_FALSE(inbox.has_work());
  ASSERT_TRUE(inbox.next_due_ns());
  EXPECT_NEAR(static_cast<double>(*inbox.next_due_ns()), 1.5e9, 2);
  inbox.take_due(at(kSecond_ns / 2 - 1'000'000));
  EXPECT_FALSE(inbox.has_work());
  inbox.take_due(at(kSecond_ns / 2 + 1000));
  EXPECT_TRUE(inbox.has_work());
  EXPECT_FALSE(inbox.next_due_ns());

  take(bundle_at(tag_of(kWall_ns - 10 * kSecond_ns), parts));
  apply();
  EXPECT_EQ(complaints.count(), 0u) << "a time that has passed is at once";
}

TEST_F(OscInbox, ABundleMoreThanAMinuteAheadIsRefused) {
  const std::vector parts{packet("/projector/brightness", 0.5f)};
  EXPECT_THAT(fault_of(bundle_at(tag_of(kWall_ns + 100 * kSecond_ns), parts)),
              HasSubstr("are the clocks of both computers right?"));
  EXPECT_THAT(fault_of(bundle_at(~0ull, parts)), HasSubstr("ahead"));
  EXPECT_FALSE(inbox.next_due_ns());
}

TEST_F(OscInbox, BundlesThatWaitAreBounded) {
  const std::vector parts{packet("/projector/brightness", 0.5f)};
  for (int i = 0; i < 1000; ++i) take(bundle_at(tag_of(kWall_ns + kSecond_ns), parts));
  EXPECT_EQ(complaints.count(), 744u);
  inbox.take_due(at(2 * kSecond_ns));
  apply();
  EXPECT_THAT(panel.sets, SizeIs(1));

  const std::vector large{packet("/light/keep_out", std::string(12'000, 'x'))};
  for (int i = 0; i < 200; ++i) take(bundle_at(tag_of(kWall_ns + kSecond_ns), large));
  EXPECT_GT(complaints.count(), 744u + 100u) << "a megabyte";
}

TEST_F(OscInbox, BundlesInBundlesEnd) {
  auto bytes = packet("/projector/brightness", 0.5f);
  for (int i = 0; i < 200; ++i) bytes = write_bundle(std::vector{bytes});
  EXPECT_THAT(fault_of(bytes), HasSubstr("a bundle in more than 3 others"));
  EXPECT_THAT(panel.sets, SizeIs(0));
  const std::vector inner{write_bundle(std::vector{packet("/projector/brightness", 0.5f)})};
  EXPECT_EQ(fault_of(write_bundle(inner)), "");
  EXPECT_THAT(panel.sets, SizeIs(1));
}

TEST_F(OscInbox, APatternSetsAllThatItStandsFor) {
  take(packet("/light/{blackout,freeze}", true));
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true");
  EXPECT_EQ(panel.value("light.freeze"), "true");
  EXPECT_THAT(fault_of(packet("/dark/*", true)), HasSubstr("no address is like"));
}

TEST_F(OscInbox, PatternsThatTakeForeverAreRefused) {
  std::string pattern = "/p";
  for (int i = 0; i < 20; ++i) pattern += "{,*}*";
  for (int i = 0; i < 1000; ++i) take(packet(pattern + "!", true));
  EXPECT_EQ(complaints.count(), 1000u);
  EXPECT_THAT(said.front(), HasSubstr("takes too long"));
  inbox.take_due(at(0));
  take(packet("/light/bl*", true));
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true");
}

TEST_F(OscInbox, RefreshIsAskedForOnce) {
  take(packet("/refresh"));
  EXPECT_TRUE(inbox.takes_refresh());
  EXPECT_FALSE(inbox.takes_refresh());
}

}  // namespace
}  // namespace handcast::desk::osc
