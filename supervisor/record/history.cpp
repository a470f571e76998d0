// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/history.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include "ipc/base/clock.hpp"
#include "supervisor/record/history_layout.hpp"

namespace handcast::supervisor {
namespace {

FrameHead head_at(const std::byte* place) {
  FrameHead head;
  std::memcpy(&head, place, sizeof(head));
  return head;
}

template <class T>
std::span<const std::byte> bytes_behind(const T* first, std::size_t count = 1) {
  return std::as_bytes(std::span(first, count));
}

ServiceName name_field(std::string_view name) {
  ServiceName field{};
  name.copy(field.data(), field.size() - 1);
  return field;
}

/// Copies the valid marks to `kept`; returns their number.
std::uint32_t keep_sensible(const msg::StageMarks& marks,
                            std::array<msg::StageMark, kMostMarks>& kept) {
  const auto count = std::min<std::size_t>(marks.count, kMostMarks);
  const auto end =
      std::copy_if(marks.marks.begin(), marks.marks.begin() + count, kept.begin(), makes_sense);
  return static_cast<std::uint32_t>(end - kept.begin());
}

tl::unexpected<Error> no_memory() {
  return fail(Errc::unavailable, fmt::format("there is no memory for a snapshot of the history: {}",
                                             std::strerror(errno)));
}

Result<void> write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return no_memory();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

}  // namespace

std::uint32_t History::index_of(std::string_view service) {
  const auto found = std::ranges::find(services_, service, &Service::name);
  const auto index = static_cast<std::uint32_t>(found - services_.begin());
  if (found == services_.end()) services_.push_back({std::string(service)});
  return index;
}

/// The newest block if it has room. Otherwise a new block, or the oldest one, whose frames are
/// dropped, if it is older than the span of the history or there are kMostBlocks.
History::Block& History::block_with_room(std::size_t bytes, std::int64_t time_ns) {
  if (!blocks_.empty() && blocks_.back().used + bytes <= kBlockBytes) return blocks_.back();
  const bool forget_oldest = !blocks_.empty() && (blocks_.front().newest_ns < time_ns - span_ns_ ||
                                                  blocks_.size() == kMostBlocks);
  if (forget_oldest)
    std::rotate(blocks_.begin(), blocks_.begin() + 1, blocks_.end());
  else
    blocks_.push_back({std::make_unique<std::byte[]>(kBlockBytes)});
  auto& block = blocks_.back();
  block.used = 0;
  block.oldest_ns = block.newest_ns = time_ns;
  return block;
}

void History::add(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed) {
  FrameHead head{
      .service = index_of(service), .header = marks.header, .made_from = marks.made_from};
  auto& unreported = services_[head.service].missed;
  unreported += missed;
  std::array<msg::StageMark, kMostMarks> kept;
  head.marks = keep_sensible(marks, kept);
  if (head.marks == 0) return;
  head.missed = static_cast<std::uint32_t>(std::min<std::uint64_t>(
      std::exchange(unreported, 0), std::numeric_limits<std::uint32_t>::max()));

  const auto time_ns = std::max<std::int64_t>(head.header.published_ns, 0);
  auto& block = block_with_room(bytes_of(head), time_ns);
  std::memcpy(block.memory.get() + block.used, &head, sizeof(head));
  std::memcpy(block.memory.get() + block.used + sizeof(head), kept.data(),
              head.marks * sizeof(kept[0]));
  block.used += bytes_of(head);
  block.oldest_ns = std::min(block.oldest_ns, time_ns);
  block.newest_ns = std::max(block.newest_ns, time_ns);
  newest_ns_ = time_ns;
}

/// The frames since a time in few pieces: whole blocks, and single frames of the block that
/// contains this time.
std::vector<std::span<const std::byte>> History::frames_since(std::int64_t since_ns) const {
  std::vector<std::span<const std::byte>> pieces;
  for (const auto& block : blocks_) {
    if (block.oldest_ns >= since_ns) {
      pieces.emplace_back(block.memory.get(), block.used);
      continue;
    }
    for (std::size_t at = 0; at < block.used && block.newest_ns >= since_ns;) {
      const auto head = head_at(block.memory.get() + at);
      if (head.header.published_ns >= since_ns)
        pieces.emplace_back(block.memory.get() + at, bytes_of(head));
      at += bytes_of(head);
    }
  }
  return pieces;
}

Result<UniqueFd> History::snapshot(std::int64_t since_ns) const {
  UniqueFd file(memfd_create("handcast history", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file) return no_memory();

  FileHead head{.taken_ns = now_ns(),
                .supervisor = getpid(),
                .services = static_cast<std::uint32_t>(services_.size())};
  std::vector<ServiceName> names;
  for (const auto& service : services_) names.push_back(name_field(service.name));
  auto pieces = frames_since(std::max(since_ns, newest_ns_ - span_ns_));
  pieces.insert(pieces.begin(), {bytes_behind(&head), bytes_behind(names.data(), names.size())});
  for (const auto& piece : pieces) head.bytes += piece.size();

  for (const auto& piece : pieces)
    if (const auto written = write_all(file.get(), piece); !written)
      return tl::make_unexpected(written.error());
  if (fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL) != 0)
    return no_memory();
  return file;
}

}  // namespace handcast::supervisor
