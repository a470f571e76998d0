// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/ring_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/ring/control_words.hpp"
#include "ipc/ring/copy.hpp"
#include "ipc/ring/row_owner.hpp"

namespace handcast::ipc {
namespace {

/// The shortest time between two sweeps. A query to the kernel takes about 10 us per reader, too
/// long to repeat for every message while readers hold all slots.
constexpr std::int64_t kBetweenSweeps_ns = 100'000'000;

/// Takes the writer lock. An OFD lock belongs to an open file description, and an inherited
/// descriptor shares its description with other processes, so the file is opened again. The kernel
/// releases the lock when the process is gone, however it ended.
Result<UniqueFd> lock_for_writing(const Segment& segment) {
  UniqueFd file(::open(fmt::format("/proc/self/fd/{}", segment.fd()).c_str(), O_RDWR | O_CLOEXEC));
  if (!file)
    return fail(Errc::unavailable, fmt::format("ring '{}': it cannot be opened for writing: {}",
                                               segment.stream(), std::strerror(errno)));
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_len = 1;
  if (::fcntl(file.get(), F_OFD_SETLK, &lock) == 0) return file;
  if (errno == EAGAIN || errno == EACCES)
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
}

Result<std::unique_ptr<RingWriter>> RingWriter::attach(Segment segment, const MessageShape& shape) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits)
    return tl::make_unexpected(fits.error());
  if (auto restricted = segment.restrict_to(Access::write); !restricted)
    return tl::make_unexpected(restricted.error());
  auto lock = lock_for_writing(segment);
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
  stamp(bytes_of(slot), now_ns());
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
