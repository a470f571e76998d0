// SPDX-License-Identifier: Apache-2.0
#include "ipc/shm/segment.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"

namespace handcast::ipc {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW;

std::string reason() { return inherited::reason_of(errno); }

template <std::size_t N>
std::string text_of(const std::array<char, N>& text) {
  return {text.begin(), std::find(text.begin(), text.end(), '\0')};
}

template <std::size_t N>
void put_text(std::array<char, N>& to, std::string_view text) {
  std::copy_n(text.begin(), std::min(text.size(), N - 1), to.begin());
}

std::string boot_id() {
  const UniqueFd file(::open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC));
  std::array<char, 36> text{};
  if (!file || ::read(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    return "unknown";
  return {text.begin(), text.end()};
}

/// The reason why a ring cannot have these sizes; empty if it can.
std::optional<std::string> size_problem(std::uint64_t slots, std::uint64_t payload_bytes) {
  if (slots < kMinSlots || slots > kMaxSlots)
    return fmt::format("{} slots, but a ring has {} to {}", slots, kMinSlots, kMaxSlots);
  if (payload_bytes < sizeof(msg::Header) || payload_bytes > kMaxPayloadBytes)
    return fmt::format("messages of {} bytes, but a message has {} to {}", payload_bytes,
                       sizeof(msg::Header), kMaxPayloadBytes);
  if (slots * round_up(payload_bytes, kLineBytes) > kMaxSegmentBytes)
    return fmt::format("{} slots of {} bytes, which is more than {} bytes in all", slots,
                       payload_bytes, kMaxSegmentBytes);
  return std::nullopt;
}

/// The reason why a file is not accepted as a ring; empty if it is. The seals guarantee that the
/// file cannot shrink while it is mapped, so no access can raise SIGBUS. Memory of the superuser is
/// accepted: root can write to this process anyway.
std::optional<std::string> file_problem(int fd, const struct stat& status) {
  const int seals = ::fcntl(fd, F_GET_SEALS);
  if (seals < 0) return "it is not a memory file";
  if ((seals & kSeals) != kSeals)
    return "its size is not sealed, so it could shrink under its readers";
  if (status.st_uid != ::geteuid() && status.st_uid != 0)
    return fmt::format("it belongs to user {}, and this process is user {}'s", status.st_uid,
                       ::geteuid());
  if (static_cast<std::uint64_t>(status.st_size) < kControlOffset)
    return fmt::format("it has only {} bytes", status.st_size);
  return std::nullopt;
}

std::optional<std::string> header_problem(const SegmentHeader& header, std::uint64_t file_bytes) {
  if (header.magic != kSegmentMagic) return "it does not begin with the header of a ring";
  if (header.layout_version != kLayoutVersion)
    return fmt::format("it has layout version {}, but this program needs version {}",
                       header.layout_version, kLayoutVersion);
  if (header.stream.back() != '\0' || header.boot_id.back() != '\0')
    return "the texts in its header are not terminated";
  if (auto problem = size_problem(header.slot_count, header.payload_bytes))
    return "its header says that it has " + *problem;
  const auto expected = with_sizes(header);
  if (header.segment_bytes != expected.segment_bytes ||
      header.slot_stride != expected.slot_stride || header.slots_offset != expected.slots_offset ||
      header.reader_rows != kReaderRows || header.leases_per_row != kLeasesPerRow)
    return "the sizes in its header contradict each other";
  if (header.segment_bytes != file_bytes)
    return fmt::format("its header says {} bytes, but the memory has {}", header.segment_bytes,
                       file_bytes);
  if (text_of(header.boot_id) != boot_id()) return "it was created before the machine last started";
  return std::nullopt;
}

std::byte* map(int fd, std::size_t bytes, Access rights) {
  const int protection = rights == Access::look ? PROT_READ : PROT_READ | PROT_WRITE;
  void* data = ::mmap(nullptr, bytes, protection, MAP_SHARED | MAP_POPULATE, fd, 0);
  return data == MAP_FAILED ? nullptr : static_cast<std::byte*>(data);
}

/// Allocates all pages now, so that a later access cannot fail for lack of memory.
bool allocate(int fd, off_t bytes) {
  if (::ftruncate(fd, bytes) != 0) return false;
  int result = 0;
  do result = ::fallocate(fd, 0, 0, bytes);
  while (result != 0 && errno == EINTR);
  return result == 0;
}

SegmentHeader header_for(const RingSpec& spec) {
  SegmentHeader header;
  header.slot_count = static_cast<std::uint32_t>(spec.slots);
  header.payload_bytes = spec.payload_bytes;
  header.keep_history = spec.keep_history ? 1 : 0;
  header.type_hash = spec.type_hash;
  header.created_ns = now_ns();
  put_text(header.boot_id, boot_id());
  put_text(header.stream, spec.stream);
  return with_sizes(header);
}

}  // namespace

Segment::Segment(UniqueFd fd, std::byte* data, const SegmentHeader& header, Access rights)
    : fd_(std::move(fd)),
      data_(data),
      size_(header.segment_bytes),
      rights_(rights),
      header_(header) {}

Segment::Segment(Segment&& other) noexcept
    : fd_(std::move(other.fd_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      rights_(other.rights_),
      header_(other.header_) {}

Segment& Segment::operator=(Segment&& other) noexcept {
  if (this == &other) return *this;
  unmap();
  fd_ = std::move(other.fd_);
  data_ = std::exchange(other.data_, nullptr);
  size_ = std::exchange(other.size_, 0);
  rights_ = other.rights_;
  header_ = other.header_;
  return *this;
}

Segment::~Segment() { unmap(); }

void Segment::unmap() {
  if (data_) ::munmap(data_, size_);
}

Result<Segment> Segment::create(const RingSpec& spec) {
  const auto ring = fmt::format("ring '{}'", spec.stream);
  if (spec.stream.empty() || spec.stream.size() >= sizeof(SegmentHeader::stream))
    return fail(Errc::bad_config, fmt::format("{}: a stream's name has 1 to {} characters", ring,
                                              sizeof(SegmentHeader::stream) - 1));
  const auto slots = spec.slots < 0 ? 0 : static_cast<std::uint64_t>(spec.slots);
  if (const auto problem = size_problem(slots, spec.payload_bytes))
    return fail(Errc::bad_config, ring + " asks for " + *problem);

  const auto header = header_for(spec);
  UniqueFd fd(::memfd_create(spec.stream.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!fd)
    return fail(Errc::unavailable,
                fmt::format("{}: its memory file cannot be created: {}", ring, reason()));
  const auto bytes = static_cast<off_t>(header.segment_bytes);
  if (!allocate(fd.get(), bytes))
    return fail(Errc::unavailable,
                fmt::format("{}: {} bytes cannot be allocated: {}", ring, bytes, reason()));
  // Not F_SEAL_FUTURE_WRITE: a restarted writer must be able to map the ring for writing.
  if (::fcntl(fd.get(), F_ADD_SEALS, kSeals | F_SEAL_SEAL) != 0)
    return fail(Errc::unavailable,
                fmt::format("{}: its size cannot be sealed: {}", ring, reason()));
  auto* data = map(fd.get(), header.segment_bytes, Access::write);
  if (!data)
    return fail(Errc::unavailable,
                fmt::format("{}: {} bytes cannot be mapped: {}", ring, bytes, reason()));
  new (data) SegmentHeader(header);  // the control words start as zeros, as memfd gives them
  return Segment(std::move(fd), data, header, Access::write);
}

Result<Segment> Segment::open(UniqueFd fd) {
  const auto not_a_ring = [&](std::string_view why) {
    return fail(Errc::bad_data,
                fmt::format("descriptor {} is not a usable ring: {}", fd.get(), why));
  };
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return not_a_ring(reason());
  if (const auto problem = file_problem(fd.get(), status)) return not_a_ring(*problem);
  SegmentHeader header;
  if (::pread(fd.get(), &header, sizeof header, 0) != static_cast<ssize_t>(sizeof header))
    return not_a_ring("its header cannot be read");
  if (const auto problem = header_problem(header, static_cast<std::uint64_t>(status.st_size)))
    return not_a_ring(*problem);
  const auto rights =
      (::fcntl(fd.get(), F_GETFL) & O_ACCMODE) == O_RDONLY ? Access::look : Access::write;
  auto* data = map(fd.get(), header.segment_bytes, rights);
  if (!data)
    return fail(Errc::unavailable,
                fmt::format("ring '{}': {} bytes cannot be mapped: {}", text_of(header.stream),
                            header.segment_bytes, reason()));
  return Segment(std::move(fd), data, header, rights);
}

Result<void> Segment::restrict_to(Access access) {
  if (access < rights_)
    return fail(Errc::unavailable,
                fmt::format("ring '{}': its mapping already has fewer rights", stream()));
  const auto forbid = [&](std::size_t from, std::size_t to) {
    return ::mprotect(data_ + from, to - from, PROT_READ) == 0;
  };
  const bool done = access == Access::write ? forbid(0, kControlOffset)
                    : access == Access::read
                        ? forbid(0, kControlOffset) && forbid(header_.slots_offset, size_)
                        : forbid(0, size_);
  if (!done)
    return fail(Errc::unavailable,
                fmt::format("ring '{}': its memory cannot be protected: {}", stream(), reason()));
  rights_ = access;
  return {};
}

// By the file: the mapping may be read-only.
bool Segment::repair_header() const {
  if (std::memcmp(data_, &header_, sizeof header_) == 0) return false;
  return ::pwrite(fd_.get(), &header_, sizeof header_, 0) == static_cast<ssize_t>(sizeof header_);
}

std::string Segment::stream() const { return text_of(header_.stream); }
std::uint64_t Segment::type_hash() const { return header_.type_hash; }
std::size_t Segment::payload_bytes() const { return header_.payload_bytes; }
int Segment::slots() const { return static_cast<int>(header_.slot_count); }
bool Segment::keep_history() const { return header_.keep_history != 0; }
std::int64_t Segment::created_ns() const { return header_.created_ns; }

std::byte* Segment::slot_at(int slot) const {
  return data_ + header_.slots_offset + static_cast<std::size_t>(slot) * header_.slot_stride;
}

Result<void> Segment::require(std::string_view layout, std::uint64_t type_hash,
                              std::size_t bytes) const {
  if (type_hash != header_.type_hash)
    return fail(Errc::bad_data, fmt::format("ring '{}': it carries another type of message than {} "
                                            "(type hash {:016x}, not {:016x})",
                                            stream(), layout, header_.type_hash, type_hash));
  if (bytes > header_.payload_bytes)
    return fail(Errc::bad_data,
                fmt::format("ring '{}': its slots of {} bytes are too small for {} ({} bytes)",
                            stream(), header_.payload_bytes, layout, bytes));
  return {};
}

}  // namespace handcast::ipc
