// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/reader_attachment.hpp"

#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/ring/row_owner.hpp"

namespace handcast::ipc {
namespace {

struct Row {
  int number = kNoSlot;
  std::uint64_t owner = 0;
};

/// Claims a row for this process: a free one, or one whose owner died without releasing it. The
/// number is kNoSlot if there is none.
Row claim_any_row(const ControlWords<RealAtomics>& words, std::uint64_t this_process) {
  for (int row = 0; row < words.rows(); ++row) {
    const auto before = RealAtomics::load(words.owner(row), std::memory_order_acquire);
    if (!owner_is_gone(before)) continue;
    const auto after = owner_word(generation_of(before) + 1, start_of_owner(this_process),
                                  pid_of_owner(this_process));
    if (claim_row(words, row, before, after)) return {row, after};
  }
  return {};
}

}  // namespace

ReaderAttachment::ReaderAttachment(Segment segment, int row, std::uint64_t owner)
    : segment_(std::move(segment)),
      row_(row),
      owner_(owner),
      core_(control_words_of(segment_), row, generation_of(owner)),
      buffers_(segment_.payload_bytes()) {
  core_.start();
  reset(tally(), core_.seen());
}

Result<std::shared_ptr<ReaderAttachment>> ReaderAttachment::take(Segment segment) {
  if (auto restricted = segment.restrict_to(Access::read); !restricted)
    return tl::make_unexpected(restricted.error());
  const auto this_process = owner_word_of_this_process(0);
  if (!this_process)
    return fail(Errc::unavailable,
                fmt::format("ring '{}': the start time of this process cannot be read from /proc",
                            segment.stream()));
  const auto row = claim_any_row(control_words_of(segment), *this_process);
  if (row.number == kNoSlot)
    return fail(Errc::unavailable, fmt::format("ring '{}': all of its {} reader rows are taken",
                                               segment.stream(), kReaderRows));
  return std::shared_ptr<ReaderAttachment>(
      new ReaderAttachment(std::move(segment), row.number, row.owner));
}

Result<std::shared_ptr<ReaderAttachment>> ReaderAttachment::watch(Segment segment) {
  if (auto restricted = segment.restrict_to(Access::look); !restricted)
    return tl::make_unexpected(restricted.error());
  return std::shared_ptr<ReaderAttachment>(new ReaderAttachment(std::move(segment), kNoRow, 0));
}

ReaderAttachment::~ReaderAttachment() {
  if (has_row()) release_row(control_words_of(segment_), row_, owner_);
}

void ReaderAttachment::sleep(ReaderCore<RealAtomics>& core, std::int64_t until_ns) const {
  if (has_row()) return core.wait(until_ns);
  core.doze(std::min(until_ns, now_ns() + kGlance_ns));
}

void ReaderAttachment::end(const Lease& lease) {
  if (core_.release(lease)) return;
  if (revoked_.fetch_add(1, std::memory_order_relaxed) == 0)
    log::error(
        "ring '{}': a message was taken away while it was read, because this process was mistaken "
        "for dead",
        segment_.stream());
}

}  // namespace handcast::ipc
