// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/ring_reader.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>

#include "ipc/ring/copy.hpp"

namespace handcast::ipc {
namespace {

/// The longest sleep before a reader looks again. A reader thus never hangs if a writer died
/// between its message and its wake-up.
constexpr std::int64_t kSlice_ns = 100'000'000;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// The wait function of a WakeBridge: waits on the futex, with its own position in the stream.
std::function<bool()> wait_for_news(const std::shared_ptr<ReaderAttachment>& attachment) {
  return [attachment = attachment.get(), core = attachment->another_core()]() mutable {
    attachment->sleep(core, now_ns() + kSlice_ns);
    if (!core.something_new()) return false;
    // Before the descriptor is made readable: later messages are reported by the next call.
    core.catch_up();
    return true;
  };
}

void wait_readable(int fd, std::int64_t until_ns) {
  const auto left_ns = std::max<std::int64_t>(until_ns - now_ns(), 0);
  const timespec left{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  pollfd wanted{fd, POLLIN, 0};
  ::ppoll(&wanted, 1, &left, nullptr);
}

/// `time_ns` - `origin_ns` without overflow: the message may hold any value.
std::int64_t age(std::int64_t origin_ns, std::int64_t time_ns) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) -
                                   static_cast<std::uint64_t>(origin_ns));
}

const msg::Header& header_of(const Held& held) {
  return *reinterpret_cast<const msg::Header*>(held.bytes());
}

}  // namespace

RingReader::RingReader(std::shared_ptr<ReaderAttachment> attachment, const MessageShape& shape,
                       Wait wait, Hold hold)
    : attachment_(std::move(attachment)), shape_(shape), wait_(wait), hold_(hold) {}

Result<std::unique_ptr<RingReader>> RingReader::attach(Segment segment, const MessageShape& shape,
                                                       Wait wait, Hold hold) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits)
    return tl::make_unexpected(fits.error());
  return over(ReaderAttachment::take(std::move(segment)), shape, wait, hold);
}

Result<std::unique_ptr<RingReader>> RingReader::watch(Segment segment, const MessageShape& shape,
                                                      Wait wait) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits)
    return tl::make_unexpected(fits.error());
  return over(ReaderAttachment::watch(std::move(segment)), shape, wait, Hold::copy);
}

Result<std::unique_ptr<RingReader>> RingReader::over(
    Result<std::shared_ptr<ReaderAttachment>> attachment, const MessageShape& shape, Wait wait,
    Hold hold) {
  if (!attachment) return tl::make_unexpected(attachment.error());
  std::unique_ptr<RingReader> reader(new RingReader(std::move(*attachment), shape, wait, hold));
  if (wait != Wait::eventfd) return reader;
  auto bridge = WakeBridge::start(wait_for_news(reader->attachment_));
  if (!bridge)
    return fail_in(fmt::format("ring '{}'", reader->attachment_->segment().stream()),
                   std::move(bridge.error()));
  reader->bridge_ = std::move(*bridge);
  return reader;
}

Result<Held> RingReader::next(Deadline deadline) {
  return take_until(deadline, [this](const auto& take, Taken& taken) {
    return attachment_->core().next(take, taken);
  });
}

Result<Held> RingReader::latest(Deadline deadline) {
  return take_until(deadline, [this](const auto& take, Taken& taken) {
    return attachment_->core().latest(take, taken);
  });
}

Result<Held> RingReader::at(std::int64_t origin_ns) {
  const auto origin_of = [this](int slot) {
    return __atomic_load_n(
        &reinterpret_cast<const msg::Header*>(attachment_->segment().slot_at(slot))->origin_ns,
        __ATOMIC_RELAXED);
  };
  const auto nearest = [&](const auto& take, Taken& taken) {
    return attachment_->core().nearest(origin_ns, origin_of, take, taken);
  };
  Held held;
  const auto outcome = attempt(nearest, held);
  if (!outcome) return tl::make_unexpected(outcome.error());
  if (*outcome == Outcome::taken) return checked(std::move(held));
  return fail_here(Errc::timeout, *outcome == Outcome::nothing
                                      ? "it is empty"
                                      : "its messages change faster than they can be read");
}

bool RingReader::await(Deadline deadline) {
  const auto has_news = [this] { return attachment_->core().something_new(); };
  while (!has_news()) {
    if (deadline.passed()) return false;
    // The descriptor is cleared before the last look, as in look().
    if (bridge_) bridge_->clear();
    if (!has_news()) wait(deadline);
  }
  return true;
}

template <class Verb>
Result<Held> RingReader::take_until(Deadline deadline, const Verb& verb) {
  for (Held held;;) {
    const auto outcome = look(verb, held);
    if (!outcome) return tl::make_unexpected(outcome.error());
    if (*outcome == Outcome::taken) return counted(std::move(held));
    if (*outcome == Outcome::corrupt)
      return fail_here(Errc::bad_data,
                       "its control words are inconsistent: another program writes to its memory");
    if (deadline.passed())
      return fail_here(Errc::timeout, "no new message came before the deadline");
    if (*outcome == Outcome::nothing) wait(deadline);
  }
}

/// With a bridge, the descriptor is cleared before the last attempt: a message that this attempt
/// does not find makes the descriptor readable again.
template <class Verb>
Result<Outcome> RingReader::look(const Verb& verb, Held& held) {
  auto outcome = attempt(verb, held);
  if (!bridge_ || !outcome || *outcome != Outcome::nothing) return outcome;
  bridge_->clear();
  return attempt(verb, held);
}

template <class Verb>
Result<Outcome> RingReader::attempt(const Verb& verb, Held& held) {
  Lease lease{hold_ == Hold::lease ? attachment_->core().free_lease() : -1};
  if (lease.index < 0) return attempt_copy(verb, held);
  Taken taken;
  const auto outcome = verb(attachment_->core().leasing(lease), taken);
  if (outcome == Outcome::taken) held = Held(attachment_, lease, taken);
  return outcome;
}

template <class Verb>
Result<Outcome> RingReader::attempt_copy(const Verb& verb, Held& held) {
  auto* buffer = attachment_->buffers().take();
  if (!buffer) return fail_here(Errc::unavailable, "there is no memory for a copy of its message");
  Taken taken;
  const auto copy = [&](int slot) { copy_out(slot, buffer->data()); };
  const auto outcome = verb(attachment_->core().copying(copy), taken);
  if (outcome != Outcome::taken) {
    buffer->give_back();
    return outcome;
  }
  if (hold_ == Hold::lease) attachment_->tally().copied.store(++copied_, std::memory_order_relaxed);
  held = Held(attachment_, *buffer, taken);
  return outcome;
}

/// Copies the bytes that the message says it uses, at most the size of the slot.
void RingReader::copy_out(int slot, std::byte* to) const {
  const auto* from = attachment_->segment().slot_at(slot);
  const auto fixed = round_up(shape_.bytes, sizeof(PayloadWord));
  copy_from_slot(to, from, fixed);
  const auto used = std::min(shape_.used_bytes(to), attachment_->segment().payload_bytes());
  if (used > fixed) copy_from_slot(to + fixed, from + fixed, used - fixed);
}

Result<Held> RingReader::checked(Held&& held) const {
  const auto claimed = shape_.used_bytes(held.bytes());
  const auto room = attachment_->segment().payload_bytes();
  if (claimed >= shape_.bytes && claimed <= room) return std::move(held);
  return fail_here(Errc::bad_data, fmt::format("message {} says it has {} bytes, its slot has {}",
                                               held.taken().sequence, claimed, room));
}

Result<Held> RingReader::counted(Held&& held) {
  const auto taken = held.taken();
  auto message = checked(std::move(held));
  auto& tally = attachment_->tally();
  tally.skipped.store(attachment_->core().skipped(), std::memory_order_relaxed);
  tally.seen.store(taken.sequence, std::memory_order_relaxed);
  if (!message) {
    tally.unusable.store(++unusable_, std::memory_order_relaxed);
    return message;
  }
  const auto& header = header_of(*message);
  tally.received.store(++received_, std::memory_order_relaxed);
  tally.age_ns.store(age(header.origin_ns, now_ns()), std::memory_order_relaxed);
  rhythm_.received(taken.sequence, header.published_ns);
  return message;
}

void RingReader::wait(Deadline deadline) {
  if (wait_ == Wait::spin) return spin(deadline.time_ns());
  const auto slice_end_ns = std::min(deadline.time_ns(), now_ns() + kSlice_ns);
  if (bridge_) return wait_readable(bridge_->fd(), slice_end_ns);
  const auto window = wait_ == Wait::predictive ? rhythm_.window() : std::nullopt;
  if (window && now_ns() < window->until_ns) {
    const auto from_ns = std::min(window->from_ns, slice_end_ns);
    while (!attachment_->core().something_new() && now_ns() < from_ns)
      attachment_->core().doze(from_ns);
    if (from_ns == window->from_ns) spin(std::min(window->until_ns, deadline.time_ns()));
    return;
  }
  attachment_->sleep(attachment_->core(), slice_end_ns);
}

void RingReader::spin(std::int64_t until_ns) const {
  while (!attachment_->core().something_new() && now_ns() < until_ns) pause();
}

tl::unexpected<Error> RingReader::fail_here(Errc code, std::string_view what) const {
  return fail(code, fmt::format("ring '{}': {}", attachment_->segment().stream(), what));
}

}  // namespace handcast::ipc
