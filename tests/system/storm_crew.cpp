// SPDX-License-Identifier: Apache-2.0
#include "tests/system/storm_crew.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <deque>
#include <random>
#include <utility>

#include "ipc/ring/writer.hpp"
#include "tests/system/storm_scroll.hpp"

namespace handcast::storm {
namespace {

using namespace std::chrono_literals;
using Random = std::minstd_rand;

ipc::Segment mapped_again(const ipc::Segment& ring) {
  auto segment = ipc::Segment::open(UniqueFd(::fcntl(ring.fd(), F_DUPFD_CLOEXEC, 0)));
  if (!segment) ::_exit(1);
  return std::move(*segment);
}

/// Publishes a scroll, or abandons the loan. Returns false if no slot was free.
bool write_one(ipc::Writer<Scroll>& writer, Notes& notes, Random& random) {
  auto scroll = writer.loan();
  if (!scroll) {
    ++notes.no_slot;
    return false;
  }
  scroll->fill(random());
  if (random() % 7 == 0) return true;
  writer.publish(std::move(scroll));
  ++notes.messages;
  return true;
}

/// One writer in four publishes without pauses, the others pause for up to 0.5 ms after each
/// message.
[[noreturn]] void write_without_end(const ipc::Segment& ring, Notes& notes, Random random) {
  auto writer = ipc::Writer<Scroll>::attach(mapped_again(ring));
  if (!writer) {
    ++notes.refused;
    ::_exit(1);
  }
  const bool restless = random() % 4 == 0;
  for (;;) {
    const bool written = write_one(*writer, notes, random);
    if (!restless || !written) ::usleep(static_cast<unsigned>(random() % 500));
  }
}

class ReaderProcess {
 public:
  ReaderProcess(ipc::Reader<Scroll> reader, const ReaderKind& kind, Notes& notes, Random random)
      : reader_(std::move(reader)), kind_(kind), notes_(notes), random_(random) {}

  [[noreturn]] void read_without_end() {
    for (;;) {
      ++notes_.turn;
      auto scroll = wait_for_one();
      if (scroll) notes_.seen = scroll->sequence();
      ++notes_.turn;
      if (scroll) judge(std::move(*scroll));
    }
  }

 private:
  using Sample = ipc::Sample<Scroll>;

  Result<Sample> take(Deadline deadline) {
    return kind_.in_order ? reader_.next(deadline) : reader_.latest(deadline);
  }

  Result<Sample> wait_for_one() {
    const auto deadline = Deadline::in(1s);
    if (reader_.event_fd() < 0) return take(deadline);
    for (;;) {
      auto scroll = take(Deadline::now());
      if (scroll || deadline.passed()) return scroll;
      pollfd event{reader_.event_fd(), POLLIN, 0};
      ::poll(&event, 1, 1000);
    }
  }

  void judge(Sample scroll) {
    ++notes_.messages;
    if (!scroll->whole()) ++notes_.torn;
    if (scroll.sequence() <= sequence_ || scroll.epoch() < epoch_) ++notes_.backwards;
    sequence_ = scroll.sequence();
    epoch_ = scroll.epoch();
    held_.push_back(std::move(scroll));
    while (held_.size() > random_() % 3)
      let_go();  // keeps zero, one or two of them during the next wait
  }

  void let_go() {
    if (!held_.front()->whole()) ++notes_.torn;
    held_.pop_front();
  }

  ipc::Reader<Scroll> reader_;
  const ReaderKind& kind_;
  Notes& notes_;
  Random random_;
  std::deque<Sample> held_;
  std::uint64_t sequence_ = 0, epoch_ = 0;
};

[[noreturn]] void read_without_end(const ipc::Segment& ring, const ReaderKind& kind, Notes& notes,
                                   Random random) {
  auto reader = ipc::Reader<Scroll>::attach(mapped_again(ring), kind.wait, kind.hold);
  if (!reader) {
    ++notes.refused;
    ::_exit(1);
  }
  ReaderProcess(std::move(*reader), kind, notes, random).read_without_end();
}

}  // namespace

void Seat::start(std::uint64_t seed) {
  notes_.turn = 0;
  notes_.seen = 0;
  pid_ = ::fork();
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const Random random(static_cast<Random::result_type>(seed));
  if (reader_) read_without_end(ring_, *reader_, notes_, random);
  write_without_end(ring_, notes_, random);
}

void Seat::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(std::exchange(pid_, -1), nullptr, 0);
}

void Seat::stop_for_a_while(bool stop) { ::kill(pid_, stop ? SIGSTOP : SIGCONT); }

std::string Seat::name() const {
  return ring_.stream() + ", " + (reader_ ? reader_->name : "writer");
}

}  // namespace handcast::storm
