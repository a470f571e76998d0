// SPDX-License-Identifier: Apache-2.0
// A reader tells a rig that is silent from one that is down.
#include <gmock/gmock.h>
#include <sys/mman.h>

#include "ipc/client/rig_presence.hpp"
#include "tests/ipc/client/rig_with_rings.hpp"

namespace handcast::client {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kNever_ns = 3'600'000'000'000;
constexpr PresenceTimes kAskAtOnce{.silence_ns = 0, .absence_ns = 0};
constexpr PresenceTimes kPatient{.silence_ns = 0, .absence_ns = kNever_ns};

class Presence : public RigWithRings {
 protected:
  RigPresence presence(const PresenceTimes& times) {
    return {"desk", "pose.hands", ring_.created_ns(), times};
  }
  void go_up() { give({{"pose.hands", ring_.fd()}}); }
  Result<void> silent(RigPresence& presence) {
    return while_it_turns([&] { return presence.silent(); });
  }

  ipc::Segment ring_ = notes("pose.hands");
};

TEST_F(Presence, ARigThatIsUpMayBeSilent) {
  go_up();
  auto desk = presence(kAskAtOnce);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(silent(desk));
}

TEST_F(Presence, ARigThatIsDownIsTold) {
  go_up();
  auto desk = presence(kAskAtOnce);
  EXPECT_TRUE(silent(desk));
  server_.reset();
  const auto down = desk.silent();
  ASSERT_FALSE(down);
  EXPECT_EQ(down.error().code, Errc::disconnected);
  EXPECT_EQ(down.error().what, "rig 'desk' is no longer up");
}

TEST_F(Presence, NobodyIsAskedBeforeTheSilenceLasts) {
  auto desk = presence({.silence_ns = kNever_ns, .absence_ns = 0});  // no rig is up
  EXPECT_TRUE(desk.silent());
}

TEST_F(Presence, ASupervisorThatIsReplacedIsWaitedFor) {
  go_up();
  auto desk = presence(kPatient);
  server_.reset();
  EXPECT_TRUE(desk.silent());
  go_up();
  EXPECT_TRUE(silent(desk));
}

TEST_F(Presence, AnAbsenceBeginsAnewAfterAMessage) {
  auto desk = presence({.silence_ns = 0, .absence_ns = 50'000'000});
  EXPECT_TRUE(desk.silent());
  sleep_until_ns(now_ns() + 60'000'000);
  desk.heard();
  EXPECT_TRUE(desk.silent());
}

TEST_F(Presence, ARigStartedAnewIsNotTheSame) {
  go_up();
  auto desk = presence(kAskAtOnce);
  const auto fresh = notes("pose.hands");
  give({{"pose.hands", fresh.fd()}});
  const auto other = silent(desk);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::disconnected);
  EXPECT_THAT(other.error().what, HasSubstr("started anew"));
}

TEST_F(Presence, ARigStartedAnewWithoutTheStreamIsNotTheSame) {
  auto desk = presence(kAskAtOnce);
  give({});
  EXPECT_FALSE(silent(desk));
}

TEST_F(Presence, ARigStartedAnewWithAnotherVersionIsNotTheSame) {
  go_up();
  auto desk = presence(kAskAtOnce);
  const UniqueFd unreadable(memfd_create("pose.hands", MFD_CLOEXEC));
  give({{"pose.hands", unreadable.get()}});
  const auto other = silent(desk);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::disconnected);
  EXPECT_THAT(other.error().what, HasSubstr("started anew"));
}

TEST_F(Presence, ASupervisorThatHangsIsThere) {
  go_up();
  auto desk = presence(kAskAtOnce);
  EXPECT_TRUE(desk.silent());  // and the loop does not turn
}

}  // namespace
}  // namespace handcast::client
