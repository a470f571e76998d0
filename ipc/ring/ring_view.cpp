// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/ring_view.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/ring/copy.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/tally.hpp"

namespace handcast::ipc {
namespace {

template <class T>
T relaxed(const std::atomic<T>& count) {
  return count.load(std::memory_order_relaxed);
}

struct Newest {
  Taken taken;
  msg::Header header;
};

/// The newest message; zeros if there is none, or if the writer overwrites it too fast. Uses only
/// those parts of ReaderCore that load words, because the mapping is read-only.
Newest newest_of(const Segment& segment) {
  ReaderCore<RealAtomics> core(control_words_of(segment), 0, 0);
  alignas(PayloadWord) std::array<std::byte, sizeof(msg::Header)> bytes{};
  const auto copy = [&](int slot) {
    copy_from_slot(bytes.data(), segment.slot_at(slot), bytes.size());
  };
  Newest newest;
  if (core.latest(core.copying(copy), newest.taken) == Outcome::taken)
    __builtin_memcpy(&newest.header, bytes.data(), bytes.size());
  return newest;
}

}  // namespace

Result<RingView> RingView::open(UniqueFd fd) {
  auto segment = Segment::open(std::move(fd));
  if (!segment) return tl::make_unexpected(segment.error());
  if (auto restricted = segment->restrict_to(Access::look); !restricted)
    return tl::make_unexpected(restricted.error());
  return RingView(std::move(*segment));
}

RingSnapshot RingView::look() const {
  const auto words = control_words_of(segment_);
  const auto newest = newest_of(segment_);
  const auto time_ns = now_ns();
  RingSnapshot ring;
  ring.stream = stream();
  ring.slots = segment_.slots();
  ring.epoch = RealAtomics::load(words.epoch(), std::memory_order_relaxed) & kEpochMask;
  ring.sequence = sequence();
  ring.published = relaxed(writer_tally(segment_).published);
  ring.dropped = relaxed(writer_tally(segment_).dropped);
  ring.pause_ns = relaxed(writer_tally(segment_).pause_ns);
  ring.newest_origin_ns = newest.header.origin_ns;
  ring.newest_published_ns = newest.header.published_ns;
  for (int row = 0; row < words.rows(); ++row)
    if (auto reader = reader_in(row, ring.sequence, time_ns); reader.pid != 0)
      ring.readers.push_back(reader);
  return ring;
}

std::uint64_t RingView::epoch() const { return newest_of(segment_).taken.epoch; }

std::uint64_t RingView::sequence() const {
  return sequence_of(
      RealAtomics::load(control_words_of(segment_).head(), std::memory_order_acquire));
}

ReaderView RingView::reader_in(int row, std::uint64_t newest, std::int64_t time_ns) const {
  const auto words = control_words_of(segment_);
  const auto& tally = reader_tally(segment_, row);
  const auto seen = relaxed(tally.seen) & kSequenceMask;
  ReaderView reader;
  reader.row = row;
  reader.pid = static_cast<pid_t>(
      pid_of_owner(RealAtomics::load(words.owner(row), std::memory_order_relaxed)));
  reader.waiting = RealAtomics::load(words.wait(row), std::memory_order_relaxed) & kWaiting;
  reader.received = relaxed(tally.received);
  reader.skipped = relaxed(tally.skipped);
  reader.unusable = relaxed(tally.unusable);
  reader.copied = relaxed(tally.copied);
  reader.lag = is_later(newest, seen) ? given_between(seen, newest) : 0;
  reader.age_ns = relaxed(tally.age_ns);
  for (int index = 0; index < kLeasesPerRow; ++index)
    reader.lease_ages_ns[static_cast<std::size_t>(index)] = lease_age_ns(row, index, time_ns);
  return reader;
}

std::int64_t RingView::lease_age_ns(int row, int index, std::int64_t time_ns) const {
  const auto& word = control_words_of(segment_).lease(row, index);
  const auto lease = RealAtomics::load(word, std::memory_order_acquire);
  if (!is_leased(lease) || slot_of_lease(lease) >= segment_.slots()) return -1;
  const auto* header = reinterpret_cast<const msg::Header*>(segment_.slot_at(slot_of_lease(lease)));
  const auto published_ns = __atomic_load_n(&header->published_ns, __ATOMIC_RELAXED);
  // The lease may have ended meanwhile, so the stamp may be of any message or torn.
  return time_ns - std::clamp<std::int64_t>(published_ns, 0, time_ns);
}

}  // namespace handcast::ipc
