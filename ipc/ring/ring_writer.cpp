// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/ring_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/ring/copy.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/row_owner.hpp"

namespace handcast::ipc {
namespace {

/// The shortest time between two sweeps. A query to the kernel takes about 10 us per reader, too
/// long to repeat for every message while readers hold all slots.
constexpr std::int64_t kBetweenSweeps_ns = 100'000'000;

/// The time between two attempts to take the writer lock.
constexpr timespec kBetweenAttempts{.tv_sec = 0, .tv_nsec = 100'000};

/// Sleeps between two attempts. Returns false, and sets errno to EINTR, if a signal arrives.
bool doze() {
  const int error = ::clock_nanosleep(CLOCK_MONOTONIC, 0, &kBetweenAttempts, nullptr);
  if (error != 0) errno = error;
  return error == 0;
}

/// When the newest message was published; 0 if there is none.
std::int64_t newest_published_ns(const Segment& segment) {
  const auto words = control_words_of(segment);
  const auto head = RealAtomics::load(words.head(), std::memory_order_acquire);
  if (sequence_of(head) == 0 || slot_of_head(head) >= words.slots()) return 0;
  const auto* header = reinterpret_cast<const msg::Header*>(segment.slot_at(slot_of_head(head)));
  return __atomic_load_n(&header->published_ns, __ATOMIC_RELAXED);
}

/// Takes the writer lock. An OFD lock belongs to an open file description, and an inherited
/// descriptor shares its description with other processes, so the file is opened again. The kernel
/// releases the lock when the process is gone, however it ended. Waits for the lock until the
/// deadline, or until a signal arrives.
Result<UniqueFd> lock_for_writing(const Segment& segment, Deadline until) {
  UniqueFd file(::open(fmt::format("/proc/self/fd/{}", segment.fd()).c_str(), O_RDWR | O_CLOEXEC));
  if (!file)
    return fail(Errc::unavailable, fmt::format("ring '{}': it cannot be opened for writing: {}",
                                               segment.stream(), std::strerror(errno)));
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_len = 1;
  const auto is_locked = [&] { return ::fcntl(file.get(), F_OFD_SETLK, &lock) == 0; };
  const auto is_busy = [] { return errno == EAGAIN || errno == EACCES; };
  bool locked = is_locked();
  while (!locked && is_busy() && !until.passed() && doze()) locked = is_locked();
  if (locked) return file;
  if (is_busy() || errno == EINTR)
    return fail(Errc::unavailable,
                fmt::format("ring '{}': another writer is attached", segment.stream()));
  return fail(Errc::unavailable, fmt::format("ring '{}': the writer lock cannot be taken: {}",
                                             segment.stream(), std::strerror(errno)));
}

void stamp(std::byte* message, std::int64_t published_ns) {
  auto* header = reinterpret_cast<msg::Header*>(message);
  __atomic_store_n(&header->published_ns, published_ns, __ATOMIC_RELAXED);
}

}  // namespace

RingWriter::RingWriter(Segment segment, UniqueFd lock)
    : segment_(std::move(segment)),
      lock_(std::move(lock)),
      core_(control_words_of(segment_)),
      slots_(segment_.slot_at(0)),
      stride_bytes_(static_cast<std::size_t>(segment_.slot_at(1) - segment_.slot_at(0))),
      tally_(writer_tally(segment_)),
      published_before_(tally_.published.load(std::memory_order_relaxed)),
      dropped_before_(tally_.dropped.load(std::memory_order_relaxed)) {
  core_.attach();
  last_before_ns_ = newest_published_ns(segment_);
}

Result<std::unique_ptr<RingWriter>> RingWriter::attach(Segment segment, const MessageShape& shape,
                                                       Deadline until) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits)
    return tl::make_unexpected(fits.error());
  if (auto restricted = segment.restrict_to(Access::write); !restricted)
    return tl::make_unexpected(restricted.error());
  auto lock = lock_for_writing(segment, until);
  if (!lock) return tl::make_unexpected(lock.error());
  return std::unique_ptr<RingWriter>(new RingWriter(std::move(segment), std::move(*lock)));
}

int RingWriter::loan() {
  const int slot = core_.loan();
  return slot != kNoSlot ? slot : loan_after_sweep();
}

int RingWriter::loan_after_sweep() {
  int slot = kNoSlot;
  if (const auto time_ns = now_ns(); time_ns >= next_sweep_ns_) {
    next_sweep_ns_ = time_ns + kBetweenSweeps_ns;
    if (sweep_dead_rows(segment_) > 0) slot = core_.loan();
  }
  if (slot == kNoSlot)
    tally_.dropped.store(dropped_before_ + ++dropped_, std::memory_order_relaxed);
  return slot;
}

void RingWriter::publish(int slot) {
  const auto time_ns = now_ns();
  stamp(bytes_of(slot), time_ns);
  if (published_ == 0)
    tally_.pause_ns.store(last_before_ns_ == 0 ? 0 : time_ns - last_before_ns_,
                          std::memory_order_relaxed);
  core_.publish(slot);
  tally_.published.store(published_before_ + ++published_, std::memory_order_relaxed);
}

void RingWriter::publish_copy(const std::byte* message, std::size_t bytes) {
  const int slot = loan();
  if (slot == kNoSlot) return;
  copy_to_slot(bytes_of(slot), message, bytes);
  publish(slot);
}

}  // namespace handcast::ipc
