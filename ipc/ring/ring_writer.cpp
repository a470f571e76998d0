#include "ipc/ring/ring_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/ring/control_words.hpp"
#include "ipc/ring/copy.hpp"

namespace handcast::ipc {
namespace {

/// OFD locks belong to an open file description, and an inherited descriptor shares its description with every other
/// process: so the file is opened anew. The kernel releases the lock when the process is gone, however it died.
Result<UniqueFd> lock_for_writing(const Segment& segment) {
  UniqueFd file(::open(fmt::format("/proc/self/fd/{}", segment.fd()).c_str(), O_RDWR | O_CLOEXEC));
  if (!file)
    return fail(Errc::unavailable, fmt::format("ring '{}': it cannot be opened for writing: {}", segment.stream(), std::strerror(errno)));
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_len = 1;
  if (::fcntl(file.get(), F_OFD_SETLK, &lock) == 0) return file;
  if (errno == EAGAIN || errno == EACCES) return fail(Errc::unavailable, fmt::format("ring '{}': another writer lives", segment.stream()));
  return fail(Errc::unavailable, fmt::format("ring '{}': the writer lock cannot be had: {}", segment.stream(), std::strerror(errno)));
}

void stamp(std::byte* message, std::int64_t published_ns) {
  auto* header = reinterpret_cast<msg::Header*>(message);
  __atomic_store_n(&header->published_ns, published_ns, __ATOMIC_RELAXED);
}

}  // namespace

RingWriter::RingWriter(Segment segment, UniqueFd lock)
    : segment_(std::move(segment)), lock_(std::move(lock)), core_(control_words_of(segment_)) {
  core_.attach();
}

Result<std::unique_ptr<RingWriter>> RingWriter::attach(Segment segment, const MessageShape& shape) {
  if (auto fits = segment.require(shape.layout, shape.type_hash, shape.bytes); !fits) return tl::make_unexpected(fits.error());
  auto lock = lock_for_writing(segment);
  if (!lock) return tl::make_unexpected(lock.error());
  return std::unique_ptr<RingWriter>(new RingWriter(std::move(segment), std::move(*lock)));
}

std::byte* RingWriter::loan() {
  const int slot = core_.loan();
  if (slot == kNoSlot) ++dropped_;
  return slot == kNoSlot ? nullptr : segment_.slot_at(slot);
}

void RingWriter::publish(std::byte* loaned) {
  stamp(loaned, now_ns());
  core_.publish(slot_of(loaned));
  ++published_;
}

void RingWriter::abandon(std::byte* loaned) { core_.abandon(slot_of(loaned)); }

void RingWriter::publish_copy(const std::byte* message, std::size_t bytes) {
  auto* loaned = loan();
  if (!loaned) return;
  copy_to_slot(loaned, message, bytes);
  publish(loaned);
}

int RingWriter::slot_of(const std::byte* loaned) const {
  const auto stride = segment_.slot_at(1) - segment_.slot_at(0);
  return static_cast<int>((loaned - segment_.slot_at(0)) / stride);
}

}  // namespace handcast::ipc
