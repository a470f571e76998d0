// SPDX-License-Identifier: Apache-2.0
// Reads a snapshot. It came over a socket, so every value is checked.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "supervisor/record/history.hpp"
#include "supervisor/record/history_layout.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kMostBytes = 2 * History::kMostBlocks * History::kBlockBytes;
constexpr std::uint32_t kMostServices = 1024;

tl::unexpected<Error> nonsense(std::string_view what) {
  return fail(Errc::bad_data, fmt::format("the history is invalid: {}", what));
}

/// A private copy of the file, which cannot change while it is checked.
Result<std::vector<std::byte>> contents_of(int fd) {
  struct stat file {};
  if (fstat(fd, &file) != 0 || !S_ISREG(file.st_mode)) return nonsense("it is not a file");
  if (file.st_size < 0 || static_cast<std::size_t>(file.st_size) > kMostBytes)
    return nonsense("its size is impossible");
  std::vector<std::byte> bytes(static_cast<std::size_t>(file.st_size));
  for (std::size_t read = 0; read < bytes.size();) {
    const auto count =
        ::pread(fd, bytes.data() + read, bytes.size() - read, static_cast<off_t>(read));
    if (count <= 0) return nonsense("it ends early");
    read += static_cast<std::size_t>(count);
  }
  return bytes;
}

/// The part of the file that was not read yet.
class Rest {
 public:
  explicit Rest(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  std::optional<T> take() {
    if (bytes_.size() < sizeof(T)) return std::nullopt;
    T value;
    std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

Result<FrameRecord> take_frame(Rest& rest, std::size_t services) {
  const auto head = rest.take<FrameHead>();
  if (!head) return nonsense("a frame ends early");
  if (head->service >= services) return nonsense("a frame belongs to no service");
  FrameRecord frame{head->service, head->missed, head->header, head->made_from, {}};
  for (std::uint32_t i = 0; i < head->marks; ++i) {
    const auto mark = rest.take<msg::StageMark>();
    if (!mark) return nonsense("a frame ends early");
    if (!makes_sense(*mark)) return nonsense("a mark has no stage, or ends before it begins");
    frame.marks.push_back(*mark);
  }
  return frame;
}

}  // namespace

Result<HistorySnapshot> read_history(const UniqueFd& file) {
  const auto bytes = contents_of(file.get());
  if (!bytes) return tl::make_unexpected(bytes.error());
  Rest rest(*bytes);
  const auto head = rest.take<FileHead>();
  if (!head || head->magic != FileHead::kMagic)
    return nonsense("it does not begin with its magic number");
  if (head->bytes != bytes->size()) return nonsense("its size differs from that in its header");
  if (head->services > kMostServices) return nonsense("it has too many services");

  HistorySnapshot snapshot{.taken_ns = head->taken_ns, .supervisor = head->supervisor};
  for (std::uint32_t i = 0; i < head->services; ++i) {
    const auto name = rest.take<ServiceName>();
    if (!name || name->back() != '\0') return nonsense("a service has no name");
    snapshot.services.emplace_back(name->data());
  }
  while (!rest.empty()) {
    auto frame = take_frame(rest, snapshot.services.size());
    if (!frame) return tl::make_unexpected(frame.error());
    snapshot.frames.push_back(std::move(*frame));
  }
  return snapshot;
}

}  // namespace handcast::supervisor
