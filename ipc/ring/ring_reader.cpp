#include "ipc/ring/ring_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/ring/control_words.hpp"
#include "ipc/ring/copy.hpp"
#include "ipc/ring/row_owner.hpp"

namespace handcast::ipc {
namespace {

/// A wait is looked at again this often, so that no lost wake-up, and no writer that died before its own, can hang a reader.
constexpr std::int64_t kSlice_ns = 100'000'000;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

struct Row {
  int number = kNoSlot;
  std::uint64_t owner = 0;
};

/// A row for this process: a free one, or one whose owner died without giving it back.
Row claim_any_row(const ControlWords<RealAtomics>& words) {
  for (int row = 0; row < words.rows(); ++row) {
    const auto before = RealAtomics::load(words.owner(row), std::memory_order_acquire);
    if (!owner_is_gone(before)) continue;
    const auto after = owner_word_of_this_process(generation_of(before) + 1);
    if (claim_row(words, row, before, after)) return {row, after};
  }
  return {};
}

}  // namespace

RingReader::RingReader(Segment segment, const MessageShape& shape, Wait wait, int row, std::uint64_t owner)
    : segment_(std::move(segment)),
      shape_(shape),
      wait_(wait),
      row_(row),
      owner_(owner),
      core_(control_words_of(segment_), row, generation_of(owner)),
      pool_(segment_.payload_bytes()) {
  core_.start();
}

Result<std::unique_ptr<RingReader>> RingReader::attach(Segment segment, const MessageShape& shape, Wait wait) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits) return tl::make_unexpected(fits.error());
  const auto row = claim_any_row(control_words_of(segment));
  if (row.number == kNoSlot)
    return fail(Errc::unavailable, fmt::format("ring '{}': all of its {} reader rows are taken", segment.stream(), kReaderRows));
  return std::unique_ptr<RingReader>(new RingReader(std::move(segment), shape, wait, row.number, row.owner));
}

RingReader::~RingReader() { release_row(control_words_of(segment_), row_, owner_); }

template <class Take>
Result<RingReader::Message> RingReader::take_until(Deadline deadline, Take take) {
  auto memory = pool_.take();
  std::size_t claimed_bytes = 0;
  const auto copy = [&](int slot) { claimed_bytes = copy_out(slot, memory.get()); };
  for (Taken taken;;) {
    const auto outcome = take(copy, taken);
    if (outcome == Outcome::corrupt) return fail_here(Errc::bad_data, "its words make no sense: something else writes to its memory");
    if (outcome == Outcome::taken) {
      auto message = checked(std::move(memory), taken, claimed_bytes);
      ++(message ? received_ : unusable_);
      if (message) rhythm_.heard(taken.sequence, reinterpret_cast<const msg::Header*>(message->memory.get())->published_ns);
      return message;
    }
    if (deadline.passed()) return fail_here(Errc::timeout, "nothing new before the deadline");
    if (outcome == Outcome::nothing) wait(deadline);
  }
}

Result<RingReader::Message> RingReader::next(Deadline deadline) {
  return take_until(deadline, [this](const auto& copy, Taken& taken) { return core_.next(copy, taken); });
}

Result<RingReader::Message> RingReader::latest(Deadline deadline) {
  return take_until(deadline, [this](const auto& copy, Taken& taken) { return core_.latest(copy, taken); });
}

Result<RingReader::Message> RingReader::at(std::int64_t origin_ns) {
  auto memory = pool_.take();
  std::size_t claimed_bytes = 0;
  Taken taken;
  const auto copy = [&](int slot) { claimed_bytes = copy_out(slot, memory.get()); };
  const auto origin_of = [this](int slot) {
    return __atomic_load_n(&reinterpret_cast<const msg::Header*>(segment_.slot_at(slot))->origin_ns, __ATOMIC_RELAXED);
  };
  switch (core_.nearest(origin_ns, origin_of, copy, taken)) {
    case Outcome::taken:
      return checked(std::move(memory), taken, claimed_bytes);
    case Outcome::nothing:
      return fail_here(Errc::timeout, "it is empty");
    default:
      return fail_here(Errc::timeout, "its messages change faster than they can be read");
  }
}

/// Copies what the message says it uses, and never more than the slot has. Returns what it says.
std::size_t RingReader::copy_out(int slot, std::byte* to) const {
  const auto* from = segment_.slot_at(slot);
  const auto fixed = round_up(shape_.bytes, sizeof(PayloadWord));
  copy_from_slot(to, from, fixed);
  const auto claimed = shape_.used_bytes(to);
  const auto used = std::min(claimed, segment_.payload_bytes());
  if (used > fixed) copy_from_slot(to + fixed, from + fixed, used - fixed);
  return claimed;
}

Result<RingReader::Message> RingReader::checked(std::shared_ptr<std::byte> memory, const Taken& taken, std::size_t claimed_bytes) const {
  const bool possible = claimed_bytes >= shape_.bytes && claimed_bytes <= segment_.payload_bytes();
  if (possible) return Message{std::move(memory), taken.sequence, taken.epoch};
  return fail_here(Errc::bad_data, fmt::format("message {} says it has {} bytes, its slot has {}", taken.sequence, claimed_bytes,
                                               segment_.payload_bytes()));
}

void RingReader::wait(Deadline deadline) {
  if (wait_ == Wait::spin) return spin(deadline.time_ns());
  const auto window = wait_ == Wait::predictive ? rhythm_.window() : std::nullopt;
  if (window && now_ns() < window->until_ns) {
    const auto from_ns = std::min({window->from_ns, deadline.time_ns(), now_ns() + kSlice_ns});
    while (!core_.something_new() && now_ns() < from_ns) core_.doze(from_ns);
    if (from_ns == window->from_ns) spin(std::min(window->until_ns, deadline.time_ns()));
    return;
  }
  core_.wait(std::min(deadline.time_ns(), now_ns() + kSlice_ns));
}

void RingReader::spin(std::int64_t until_ns) const {
  while (!core_.something_new() && now_ns() < until_ns) pause();
}

tl::unexpected<Error> RingReader::fail_here(Errc code, std::string_view what) const {
  return fail(code, fmt::format("ring '{}': {}", segment_.stream(), what));
}

}  // namespace handcast::ipc
