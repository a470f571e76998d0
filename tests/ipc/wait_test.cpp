// SPDX-License-Identifier: Apache-2.0
// Waiting readers are woken: by the futex, through an eventfd, in an epoll loop. A lost wake-up
// ends a test after 20 s.
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/epoll.h>

#include <csignal>
#include <random>
#include <thread>

#include "tests/ipc/ring_testing.hpp"
#include "tests/ipc/small_ring.hpp"

namespace handcast::ipc {
namespace {

using namespace std::chrono_literals;
using namespace handcast::ipc::samples;
using ::testing::HasSubstr;

constexpr int kLong_ms = 20'000;

bool readable(int fd, int patience_ms) {
  pollfd wanted{fd, POLLIN, 0};
  return ::poll(&wanted, 1, patience_ms) == 1;
}

Reader<Note> bridged(const Segment& segment) {
  return must(Reader<Note>::attach(again(segment), Wait::eventfd));
}

TEST(Wakeups, NoneIsLostBetweenAFlagAndAHead) {
  constexpr std::uint64_t kMessages = 20'000;
  SmallRing ring(3, false);
  std::atomic<std::uint64_t> seen{0};
  std::jthread thread([&] {
    WriterCore<RealAtomics> writer(ring.words());
    writer.attach();
    std::mt19937 random(1);
    for (std::uint64_t i = 1; i <= kMessages; ++i) {
      while (seen.load() + 1 < i) continue;  // publish when the reader is about to wait
      for (auto steps = random() % 200; steps > 0; --steps)
        std::atomic_signal_fence(std::memory_order_seq_cst);
      writer.publish(writer.loan());
    }
  });
  ReaderCore<RealAtomics> reader(ring.words(), 0, 0);
  const auto give_up_ns = now_ns() + kLong_ms * std::int64_t{1'000'000};
  while (reader.seen() < kMessages && now_ns() < give_up_ns) {
    while (!reader.something_new() && now_ns() < give_up_ns) reader.wait(give_up_ns);
    reader.catch_up();
    seen.store(reader.seen());
  }
  EXPECT_EQ(reader.seen(), kMessages) << "the reader has missed a message while it slept";
}

// Below Reader, which looks again from time to time even if it is not woken.
TEST(Wakeups, OneMessageWakesAllReadersThatSleep) {
  SmallRing ring(3, false);
  WriterCore<RealAtomics> writer(ring.words());
  writer.attach();
  for (std::uint64_t message = 1; message <= 10; ++message) {
    std::array<bool, SmallRing::kRows> woken{};
    {
      std::vector<std::jthread> readers;
      for (int row = 0; row < SmallRing::kRows; ++row)
        readers.emplace_back([&, row] {
          ReaderCore<RealAtomics> reader(ring.words(), row, 0);
          reader.catch_up();
          const auto give_up_ns = now_ns() + kLong_ms * std::int64_t{1'000'000};
          while (!reader.something_new() && now_ns() < give_up_ns) reader.wait(give_up_ns);
          woken[row] = now_ns() < give_up_ns;
        });
      const auto wants_to_be_woken = [&](int row) {
        return (RealAtomics::load(ring.words().wait(row), std::memory_order_relaxed) & kWaiting) !=
               0;
      };
      for (int row = 0; row < SmallRing::kRows; ++row)
        while (!wants_to_be_woken(row)) std::this_thread::yield();
      std::this_thread::sleep_for(5ms);  // until they sleep; otherwise nothing is tested
      writer.publish(writer.loan());
    }
    ASSERT_THAT(woken, ::testing::Each(true));
  }
}

TEST(Await, SaysWhetherThereIsAMessageWithoutTakingIt) {
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex, Wait::eventfd}) {
    const auto segment = make_ring<Note>(4, true);
    auto writer = must(Writer<Note>::attach(again(segment)));
    auto reader = must(Reader<Note>::attach(again(segment), wait));
    for (std::uint64_t round = 1; round < 9; ++round) {
      EXPECT_FALSE(reader.await(kNow));
      EXPECT_FALSE(reader.await(Deadline::in(1ms)));
      writer.publish(note(round));
      EXPECT_TRUE(reader.await(kNow));
      EXPECT_TRUE(reader.await(kNow));
      EXPECT_EQ(must(reader.next(kNow))->value, round);
    }
  }
}

TEST(Await, AMessageEndsTheWait) {
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex, Wait::eventfd}) {
    const auto segment = make_ring<Note>(64, true);
    auto reader = must(Reader<Note>::attach(again(segment), wait));
    std::jthread thread([&] {
      auto writer = must(Writer<Note>::attach(again(segment)));
      for (std::uint64_t i = 1; i <= 20; ++i) {
        std::this_thread::sleep_for(500us);
        writer.publish(note(i));
      }
    });
    for (std::uint64_t i = 1; i <= 20; ++i) {
      ASSERT_TRUE(reader.await(Deadline::in(20s)));
      EXPECT_EQ(must(reader.next(kNow))->value, i);
    }
  }
}

TEST(EventFd, ThereIsNoneForTheOtherWays) {
  const auto segment = make_ring<Note>(4);
  for (const auto wait : {Wait::spin, Wait::predictive, Wait::futex})
    EXPECT_EQ(must(Reader<Note>::attach(again(segment), wait)).event_fd(), -1);
}

TEST(EventFd, IsReadableFromAMessageUntilThereIsNothingMore) {
  const auto segment = make_ring<Note>(4, true);
  auto writer = must(Writer<Note>::attach(again(segment)));
  auto reader = bridged(segment);
  for (std::uint64_t round = 0; round < 20; ++round) {
    EXPECT_FALSE(reader.next(kNow));
    EXPECT_FALSE(readable(reader.event_fd(), 0));
    writer.publish(note(2 * round));
    ASSERT_TRUE(readable(reader.event_fd(), kLong_ms));
    writer.publish(note(2 * round + 1));
    EXPECT_EQ(must(reader.next(kNow))->value, 2 * round);
    EXPECT_TRUE(readable(reader.event_fd(), 0)) << "there is one more message";
    EXPECT_EQ(must(reader.next(kNow))->value, 2 * round + 1);
    // The second message may be reported late.
    for (int looks = 0; looks < 3 && readable(reader.event_fd(), 5); ++looks)
      EXPECT_FALSE(reader.next(kNow));
  }
}

TEST(EventFd, IsReadableAtOnceForALateReader) {
  const auto segment = make_ring<Note>(4);
  must(Writer<Note>::attach(again(segment))).publish(note(1));
  auto reader = bridged(segment);
  EXPECT_TRUE(readable(reader.event_fd(), kLong_ms));
  EXPECT_EQ(must(reader.latest(kNow))->value, 1u);
}

TEST(EventFd, TheReadersOwnWaitIsWokenToo) {
  const auto segment = make_ring<Note>(64, true);
  auto reader = bridged(segment);
  std::jthread thread([&] {
    auto writer = must(Writer<Note>::attach(again(segment)));
    for (std::uint64_t i = 1; i <= 50; ++i) {
      std::this_thread::sleep_for(500us);
      writer.publish(note(i));
    }
  });
  for (std::uint64_t i = 1; i <= 50; ++i) EXPECT_EQ(must(reader.next(Deadline::in(20s)))->value, i);
}

/// Publishes messages, each as soon as the last one was seen: at that moment the reader clears its
/// descriptor and looks once more.
void publish_in_step(const Segment& segment, const std::atomic<std::uint64_t>& seen,
                     std::uint64_t messages, unsigned seed) {
  auto writer = must(Writer<Note>::attach(again(segment)));
  std::mt19937 random(seed);
  const auto give_up = Deadline::in(60s);
  for (std::uint64_t i = 1; i <= messages && !give_up.passed(); ++i) {
    while (seen.load() + 1 < i && !give_up.passed()) std::this_thread::yield();
    for (auto steps = random() % 20'000; steps > 0; --steps)
      std::atomic_signal_fence(std::memory_order_seq_cst);
    writer.publish(note(i));
  }
}

TEST(EventFd, AnEpollLoopWithTwoRingsMissesNothingOfEither) {
  constexpr std::uint64_t kMessages = 1000;
  const std::array segments{make_ring<Note>(16, true), make_ring<Note>(16, true)};
  std::array readers{bridged(segments[0]), bridged(segments[1])};
  std::array<std::atomic<std::uint64_t>, 2> seen{};
  const UniqueFd epoll(::epoll_create1(EPOLL_CLOEXEC));
  for (std::uint32_t i = 0; i < readers.size(); ++i) {
    epoll_event event{.events = EPOLLIN, .data = {.u32 = i}};
    ASSERT_EQ(::epoll_ctl(epoll.get(), EPOLL_CTL_ADD, readers[i].event_fd(), &event), 0);
  }
  std::jthread first([&] { publish_in_step(segments[0], seen[0], kMessages, 1); });
  std::jthread second([&] { publish_in_step(segments[1], seen[1], kMessages, 2); });
  while (seen[0] < kMessages || seen[1] < kMessages) {
    epoll_event event{};
    const auto events = ::epoll_wait(epoll.get(), &event, 1, kLong_ms);
    if (events < 0 && errno == EINTR) continue;
    ASSERT_EQ(events, 1) << "a message was not reported; " << seen[0] << " and " << seen[1]
                         << " messages were seen";
    auto& reader = readers[event.data.u32];
    auto& count = seen[event.data.u32];
    while (const auto sample = reader.next(kNow)) {
      EXPECT_EQ((*sample)->value, count + 1);
      count = (*sample)->value;
    }
  }
}

TEST(WakeBridge, TellsOfWhatComesAfterTheDescriptorWasCleared) {
  std::atomic<int> news{0};
  const auto bridge = must(WakeBridge::start([&, reported = 0]() mutable {
    std::this_thread::sleep_for(1ms);
    return std::exchange(reported, news.load()) != news.load();
  }));
  EXPECT_FALSE(readable(bridge->fd(), 10));
  for (int i = 0; i < 5; ++i) {
    ++news;
    ASSERT_TRUE(readable(bridge->fd(), kLong_ms));
    bridge->clear();
    EXPECT_FALSE(readable(bridge->fd(), 0));
  }
}

TEST(WakeBridge, ItsThreadTakesNoSignals) {
  static std::atomic<std::thread::id> handled_by{};
  const auto before = std::signal(SIGUSR1, [](int) { handled_by = std::this_thread::get_id(); });
  std::atomic<bool> runs{false};
  const auto bridge = must(WakeBridge::start([&] {
    runs = true;
    std::this_thread::sleep_for(1ms);
    return false;
  }));
  while (!runs) std::this_thread::yield();
  for (int i = 0; i < 20; ++i) {
    handled_by = std::thread::id();
    ::kill(::getpid(), SIGUSR1);
    while (handled_by.load() == std::thread::id()) std::this_thread::yield();
    EXPECT_EQ(handled_by.load(), std::this_thread::get_id());
  }
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace handcast::ipc
