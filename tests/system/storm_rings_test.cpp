// SPDX-License-Identifier: Apache-2.0
// Random writers and readers of three rings are killed and replaced, hundreds of times.
//   HANDCAST_STORM_KILLS=10000   kills instead of 500
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/ipc/ring_testing.hpp"
#include "tests/system/storm_crew.hpp"
#include "tests/system/storm_scroll.hpp"
#include "tests/system/storm_watch.hpp"

namespace handcast::storm {
namespace {

using ipc::samples::again;
using ipc::samples::must;

constexpr int kUsualKills = 500;
constexpr std::int64_t kHang_ns =
    250'000'000;  ///< on a busy machine a process may get no processor for 120 ms
constexpr std::int64_t kLook_every_ns = 2'000'000;

int kills_asked() {
  const char* text = std::getenv("HANDCAST_STORM_KILLS");
  return text ? std::max(1, std::atoi(text)) : kUsualKills;
}

struct RingKind {
  const char* name;
  int slots;
  bool keep_history;
};
constexpr std::array<RingKind, 3> kRings{
    {{"storm.few", 3, false}, {"storm.rig", 8, false}, {"storm.history", 16, true}}};
constexpr std::size_t kSeatsPerRing = 1 + kReaderKinds.size();

std::size_t entries_of(const std::filesystem::path& folder) {
  std::error_code absent;
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder, absent), {}));
}

/// Processes of this user that still have a ring of the storm mapped.
int processes_with_a_ring() {
  int count = 0;
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream maps(process.path() / "maps");
    for (std::string line; std::getline(maps, line);)
      if (line.find("memfd:storm.") != std::string::npos) {
        ++count;
        break;
      }
  }
  return count;
}

/// Zeroed memory that all processes of the storm share.
class SharedNotes {
 public:
  SharedNotes()
      : memory_(
            ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    notes_ = new (memory_) Notes[kCount];
  }
  ~SharedNotes() { ::munmap(memory_, kBytes); }
  SharedNotes(const SharedNotes&) = delete;
  Notes& operator[](std::size_t i) const { return notes_[i]; }

 private:
  static constexpr std::size_t kCount = kRings.size() * kSeatsPerRing;
  static constexpr std::size_t kBytes = kCount * sizeof(Notes);
  void* memory_;
  Notes* notes_;
};

class Storm {
 public:
  Storm() {
    for (const auto& kind : kRings)
      rings_.push_back(must(ipc::Segment::create(ipc::RingSpec::of<Scroll>(
          kind.name, kind.slots, kind.keep_history, Scroll::most_bytes()))));
    for (const auto& ring : rings_) {
      take_seat(ring, nullptr);
      for (const auto& kind : kReaderKinds) take_seat(ring, &kind);
    }
    for (const auto& seat : seats_)
      if (seat->is_reader()) watches_.emplace_back(*seat);
  }

  void rage(int kills) {
    for (const auto& seat : seats_) seat->start(random_());
    for (int i = 0; i < kills; ++i) {
      look_on_until(now_ns() + static_cast<std::int64_t>(random_() % 20'000'000));
      auto& victim = *seats_[random_() % seats_.size()];
      if (random_() % 8 == 0) pause(*seats_[random_() % seats_.size()]);
      victim.kill();
      victim.start(random_());
    }
    look_on_until(now_ns() + 2 * kHang_ns);  // finds readers that miss a wake-up
    for (const auto& seat : seats_) seat->kill();
  }

  /// The number of slots that cannot be used again after the death of all processes.
  int leaked_slots() const {
    int leaked = 0;
    for (const auto& ring : rings_) {
      clear_the_rows_of_the_dead(ring);
      auto writer = must(ipc::Writer<Scroll>::attach(again(ring)));
      std::vector<ipc::Loan<Scroll>> loans;
      for (auto loan = writer.loan(); loan; loan = writer.loan()) loans.push_back(std::move(loan));
      leaked +=
          ring.slots() - 1 - static_cast<int>(loans.size());  // the newest message is never on loan
    }
    return leaked;
  }

  std::uint64_t total(std::atomic<std::uint64_t> Notes::*count, bool of_readers) const {
    std::uint64_t sum = 0;
    for (const auto& seat : seats_)
      if (seat->is_reader() == of_readers) sum += seat->notes().*count;
    return sum;
  }
  const std::vector<std::unique_ptr<Seat>>& seats() const { return seats_; }
  std::int64_t longest_sleep_ns() const {
    std::int64_t longest_ns = 0;
    for (const auto& watch : watches_) longest_ns = std::max(longest_ns, watch.longest_ns());
    return longest_ns;
  }
  int late_wakings() const {
    int late = 0;
    for (const auto& watch : watches_) late += watch.late();
    return late;
  }

 private:
  void take_seat(const ipc::Segment& ring, const ReaderKind* reader) {
    seats_.push_back(std::make_unique<Seat>(ring, reader, notes_[seats_.size()]));
  }

  void look_on_until(std::int64_t end_ns) {
    for (auto now = now_ns();; now = now_ns()) {
      for (auto& watch : watches_) watch.look(now);
      if (paused_ && now > paused_until_ns_) go_on();
      if (now >= end_ns) return;
      sleep_until_ns(std::min(end_ns, now + kLook_every_ns));
    }
  }

  /// Stops a process at a random place and continues it later; its leases must hold meanwhile.
  void pause(Seat& seat) {
    if (paused_) go_on();
    paused_ = &seat;
    paused_until_ns_ = now_ns() + static_cast<std::int64_t>(random_() % 40'000'000);
    seat.stop_for_a_while(true);
  }
  void go_on() { std::exchange(paused_, nullptr)->stop_for_a_while(false); }

  static void clear_the_rows_of_the_dead(const ipc::Segment& ring) {
    std::vector<ipc::Reader<Scroll>> everybody;
    for (int i = 0; i < ipc::kReaderRows; ++i)
      everybody.push_back(must(ipc::Reader<Scroll>::attach(again(ring))));
  }

  std::mt19937 random_{7};
  std::vector<ipc::Segment> rings_;
  SharedNotes notes_;
  std::vector<std::unique_ptr<Seat>> seats_;
  std::vector<Watch> watches_;
  Seat* paused_ = nullptr;
  std::int64_t paused_until_ns_ = 0;
};

TEST(RingStorm, KillsAtRandomLeaveNothingTornNothingLostAndNobodyAsleep) {
  const auto descriptors = entries_of("/proc/self/fd"), shared_memory = entries_of("/dev/shm");
  const int kills = kills_asked();
  {
    auto storm = std::make_unique<Storm>();
    storm->rage(kills);
    EXPECT_EQ(storm->total(&Notes::torn, true), 0u);
    EXPECT_EQ(storm->total(&Notes::backwards, true), 0u);
    EXPECT_EQ(storm->total(&Notes::refused, true) + storm->total(&Notes::refused, false), 0u);
    EXPECT_LE(storm->longest_sleep_ns(), kHang_ns);
    EXPECT_LE(storm->late_wakings(), 1 + kills / 50) << "wake-ups are lost";
    EXPECT_EQ(storm->leaked_slots(), 0);
    for (const auto& seat : storm->seats()) EXPECT_GT(seat->notes().messages, 0u) << seat->name();
    std::printf(
        "%d kills: %llu messages written, %llu read, %llu times no slot, %d late wake-ups, longest "
        "sleep beside something new %.1f ms\n",
        kills, static_cast<unsigned long long>(storm->total(&Notes::messages, false)),
        static_cast<unsigned long long>(storm->total(&Notes::messages, true)),
        static_cast<unsigned long long>(storm->total(&Notes::no_slot, false)),
        storm->late_wakings(), ns_to_ms(storm->longest_sleep_ns()));
  }
  EXPECT_EQ(entries_of("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries_of("/dev/shm"), shared_memory);
  EXPECT_EQ(processes_with_a_ring(), 0);
}

}  // namespace
}  // namespace handcast::storm
