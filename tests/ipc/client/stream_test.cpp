// SPDX-License-Identifier: Apache-2.0
// Opening and reading a stream of a rig from outside.
#include "ipc/client/stream.hpp"

#include <gmock/gmock.h>

#include "tests/ipc/client/rig_with_rings.hpp"

namespace handcast::client {
namespace {

using namespace std::chrono_literals;
using ipc::Writer;
using ipc::samples::again;
using ipc::samples::must;
using ipc::samples::Note;
using ipc::samples::note;
using ipc::samples::OtherNote;
using testing::AllOf;
using testing::HasSubstr;

class OpenStream : public RigWithRings {
 protected:
  Result<Stream<Note>> open(const std::string& rig, const std::string& stream) {
    return while_it_turns([=] { return open_stream<Note>(rig, stream); });
  }
};

TEST_F(OpenStream, GivesTheMessagesOfTheRingOfThatName) {
  const auto poses = notes("pose.hands"), hands = notes("landmarks.hands");
  give({{"pose.hands", poses.fd()}, {"landmarks.hands", hands.fd()}});
  auto writer = must(Writer<Note>::attach(again(hands)));
  writer.publish(note(1));
  auto stream = open("desk", "landmarks.hands");
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_EQ(stream->rig(), "desk");
  EXPECT_EQ(must(stream->next(Deadline::in(1s)))->value, 1u);
  writer.publish(note(2, 500));
  writer.publish(note(3, 600));
  EXPECT_EQ(must(stream->latest(Deadline::now()))->value, 3u);
  EXPECT_EQ(must(stream->at(510))->value, 2u);
  EXPECT_EQ(stream->next(Deadline::now()).error().code, Errc::timeout);
}

TEST_F(OpenStream, TheOnlyRigNeedsNoName) {
  const auto ring = notes("pose.hands");
  give({{"pose.hands", ring.fd()}});
  const auto stream = open("", "pose.hands");
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_EQ(stream->rig(), "desk");
}

TEST_F(OpenStream, WithoutARigTheSentenceSaysHowToStartOne) {
  const auto stream = open_stream<Note>("desk", "pose.hands");
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::unavailable);
  EXPECT_THAT(stream.error().what, AllOf(HasSubstr("no rig is up"), HasSubstr("handcast up")));
}

TEST_F(OpenStream, ARigOfAnotherNameIsNamed) {
  give({});
  const auto stream = open("wall", "pose.hands");
  ASSERT_FALSE(stream);
  EXPECT_THAT(stream.error().what, AllOf(HasSubstr("'wall'"), HasSubstr("there is: desk")));
}

TEST_F(OpenStream, AStreamThatIsNotThereIsAnsweredWithThoseThatAre) {
  const auto ring = notes("pose.hands"), frames = notes("camera.frames");
  give({{"camera.frames", frames.fd()}, {"pose.hands", ring.fd()}});
  const auto stream = open("desk", "pose.hand");
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::bad_config);
  EXPECT_EQ(stream.error().what,
            "rig 'desk' has no stream 'pose.hand'; it has: camera.frames, pose.hands");
}

TEST_F(OpenStream, AStreamOfAnotherTypeIsRefused) {
  const auto ring = notes("pose.hands");
  give({{"pose.hands", ring.fd()}});
  const auto stream = while_it_turns([] { return open_stream<OtherNote>("desk", "pose.hands"); });
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::bad_data);
  EXPECT_THAT(stream.error().what, HasSubstr("another type of message than OtherNote/1"));
}

TEST_F(OpenStream, NothingInTheRingTellsOfTheReader) {
  const auto ring = notes("pose.hands");
  give({{"pose.hands", ring.fd()}});
  const std::vector<std::byte> before(ring.data(), ring.data() + ring.size());
  auto stream = open("desk", "pose.hands");
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_FALSE(stream->next(Deadline::in(5ms)));
  EXPECT_EQ(std::vector<std::byte>(ring.data(), ring.data() + ring.size()), before);
}

TEST_F(OpenStream, ALongWaitEndsWhenTheRigDoes) {
  const auto ring = notes("pose.hands");
  Stream<Note> stream(must(ipc::Reader<Note>::watch(again(ring))),
                      RigPresence("desk", "pose.hands", ring.created_ns(), {0, 0}), "desk");
  const auto message = stream.next(Deadline::in(1h));
  ASSERT_FALSE(message);
  EXPECT_EQ(message.error().code, Errc::disconnected);
  EXPECT_EQ(message.error().what, "rig 'desk' is no longer up");
}

TEST_F(OpenStream, WhileMessagesComeNobodyAsksForTheSupervisor) {
  const auto ring = notes("pose.hands");
  auto writer = must(Writer<Note>::attach(again(ring)));
  constexpr PresenceTimes kTimes{.silence_ns = 50'000'000, .absence_ns = 0};
  Stream<Note> stream(must(ipc::Reader<Note>::watch(again(ring))),
                      RigPresence("desk", "pose.hands", ring.created_ns(), kTimes), "desk");
  const auto end_ns = now_ns() + 2 * kTimes.silence_ns;  // no rig is up: who asks is told so
  for (std::uint64_t i = 1; now_ns() < end_ns; ++i) {
    const auto begin_ns = now_ns();
    writer.publish(note(i));
    EXPECT_EQ(must(stream.next(Deadline::in(1s)))->value, i);
    const auto nothing = stream.next(Deadline::now());
    ASSERT_FALSE(nothing);
    const bool halted = now_ns() - begin_ns >= kTimes.silence_ns;  // a silence by the machine
    ASSERT_TRUE(halted || nothing.error().code == Errc::timeout) << nothing.error().what;
  }
}

}  // namespace
}  // namespace handcast::client
