// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/state_memory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include "ipc/base/inherited.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kSlotBytes = 256 << 10;  ///< a rig needs about 20 KB
constexpr std::uint64_t kMagic = 0x6574617473636801;

tl::unexpected<Error> cannot(std::string_view what) {
  return fail(Errc::unavailable, fmt::format("the memory for the supervisor's state {}: {}", what,
                                             inherited::reason_of(errno)));
}

}  // namespace

struct StateMemory::Layout {
  /// A saved text.
  struct Slot {
    std::uint64_t bytes;
    std::array<char, kSlotBytes - sizeof bytes> text;
  };

  std::uint64_t magic;
  std::atomic<std::uint32_t> saves;  ///< number of save(); 0: nothing is saved
  std::array<Slot, 2> slots;         ///< slots[saves % 2] is valid
};

Result<StateMemory> StateMemory::create() {
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
  UniqueFd file(memfd_create("handcast-state", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file) return cannot("cannot be created");
  if (const int error = posix_fallocate(file.get(), 0, sizeof(Layout)); error != 0) {
    errno = error;
    return cannot("cannot be reserved");
  }
  const std::uint64_t magic = kMagic;
  if (::pwrite(file.get(), &magic, sizeof magic, 0) != sizeof magic)
    return cannot("cannot be written");
  fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL);
  return open(std::move(file));
}

Result<StateMemory> StateMemory::open(UniqueFd file) {
  struct stat status {};
  constexpr int kFixedSize = F_SEAL_SHRINK | F_SEAL_GROW;  // without them, reading may raise SIGBUS
  if (fstat(file.get(), &status) != 0 || status.st_size != sizeof(Layout) ||
      (fcntl(file.get(), F_GET_SEALS) & kFixedSize) != kFixedSize)
    return fail(Errc::bad_data, "the saved state of the supervisor is another file");
  void* bytes = mmap(nullptr, sizeof(Layout), PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (bytes == MAP_FAILED) return cannot("cannot be mapped");
  StateMemory memory(std::move(file), static_cast<Layout*>(bytes));
  if (memory.layout_->magic != kMagic)
    return fail(Errc::bad_data, "the saved state of the supervisor is another file");
  return memory;
}

StateMemory::StateMemory(UniqueFd file, Layout* layout) : file_(std::move(file)), layout_(layout) {}

StateMemory::StateMemory(StateMemory&& other) noexcept
    : file_(std::move(other.file_)), layout_(std::exchange(other.layout_, nullptr)) {}

StateMemory& StateMemory::operator=(StateMemory&& other) noexcept {
  if (this == &other) return *this;
  unmap();
  file_ = std::move(other.file_);
  layout_ = std::exchange(other.layout_, nullptr);
  return *this;
}

StateMemory::~StateMemory() { unmap(); }

void StateMemory::unmap() {
  if (layout_) munmap(layout_, sizeof(Layout));
}

Result<void> StateMemory::save(const SavedRig& rig) {
  const auto text = print_saved(rig);
  const auto saves = layout_->saves.load(std::memory_order_relaxed) + 1;
  auto& slot = layout_->slots[saves % 2];
  if (text.size() > slot.text.size())
    return fail(Errc::unavailable,
                fmt::format("the state of rig '{}' has {} bytes; {} can be saved", rig.name,
                            text.size(), slot.text.size()));
  std::ranges::copy(text, slot.text.begin());
  slot.bytes = text.size();
  layout_->saves.store(saves, std::memory_order_release);
  return {};
}

void StateMemory::forget() { layout_->saves.store(0, std::memory_order_release); }

Result<SavedRig> StateMemory::load(const std::string& name) const {
  const auto saves = layout_->saves.load(std::memory_order_acquire);
  const auto& slot = layout_->slots[saves % 2];
  if (saves == 0 || slot.bytes > slot.text.size())
    return fail(Errc::bad_data, fmt::format("no state of rig '{}' is saved", name));
  return parse_saved(std::string(slot.text.data(), slot.bytes), name);
}

}  // namespace handcast::supervisor
