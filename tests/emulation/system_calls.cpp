// SPDX-License-Identifier: Apache-2.0
// The system calls of this process. Those that do not concern emulated devices go on to the C
// library.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include "tests/emulation/emulated_device.hpp"

namespace handcast::test {
namespace {

/// It is made at its first use, which may be before main().
struct Registry {
  std::mutex mutex;
  std::vector<std::shared_ptr<EmulatedDevice>> devices;
  std::vector<std::string> hidden;
};
Registry& registry() {
  static auto* the_registry = new Registry;  // it outlives static objects that close files
  return *the_registry;
}

template <class Predicate>
std::shared_ptr<EmulatedDevice> find(Predicate predicate) {
  auto& [mutex, devices, hidden] = registry();
  const std::lock_guard lock(mutex);
  const auto found = std::ranges::find_if(devices, predicate);
  return found == devices.end() ? nullptr : *found;
}
std::shared_ptr<EmulatedDevice> device_of(int fd) {
  return find([fd](const auto& device) { return device->owns(fd); });
}
std::shared_ptr<EmulatedDevice> device_at(std::string_view path) {
  return find([path](const auto& device) { return device->is_at(path); });
}

bool is_hidden(std::string_view path) {
  auto& [mutex, devices, hidden] = registry();
  const std::lock_guard lock(mutex);
  return std::ranges::any_of(hidden, [path](const auto& begin) { return path.starts_with(begin); });
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int with_errno(int answer) {
  if (answer >= 0) return answer;
  errno = -answer;
  return -1;
}

int open_path(const char* function, const char* path, int flags, mode_t mode) {
  if (const auto device = device_at(path)) return with_errno(device->open());
  if (is_hidden(path)) return with_errno(-ENOENT);
  return real<int(const char*, int, ...)>(function)(path, flags, mode);
}

mode_t mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

int poll_one(EmulatedDevice& device, pollfd& watched, const timespec* span) {
  const auto now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
  const std::int64_t until_ns =
      span == nullptr ? INT64_MAX : now_ns + span->tv_sec * 1'000'000'000 + span->tv_nsec;
  watched.revents = device.poll(watched.fd, watched.events, until_ns);
  return watched.revents != 0 ? 1 : 0;
}

/// The emulated device that is asked in a poll of it alone.
std::shared_ptr<EmulatedDevice> polled(const pollfd* watched, nfds_t count) {
  for (nfds_t i = 0; i < count; ++i) {
    auto device = device_of(watched[i].fd);
    if (!device || !device->answers_polls()) continue;
    if (count != 1) std::abort();  // nobody polls several, so it is not emulated
    return device;
  }
  return nullptr;
}

}  // namespace

void hide(std::string_view beginning) {
  const std::lock_guard lock(registry().mutex);
  registry().hidden.emplace_back(beginning);
}

void attach(std::shared_ptr<EmulatedDevice> device) {
  const std::lock_guard lock(registry().mutex);
  registry().devices.push_back(std::move(device));
}

void detach(const EmulatedDevice* device) {
  const std::lock_guard lock(registry().mutex);
  std::erase_if(registry().devices, [device](const auto& one) { return one.get() == device; });
}

int EmulatedDevice::stat(struct stat& file) const {
  constexpr gid_t kVideo = 44;  // of Debian
  file = {};
  file.st_mode = S_IFCHR | S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP;
  file.st_gid = kVideo;
  return 0;
}

short EmulatedDevice::poll(int, short, std::int64_t) { return 0; }

}  // namespace handcast::test

using namespace handcast::test;

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path("open64", path, flags, mode);
}

int close(int fd) {
  if (const auto device = device_of(fd)) device->close(fd);
  return real<int(int)>("close")(fd);
}

int stat(const char* path, struct stat* file) noexcept {
  if (const auto device = device_at(path)) return with_errno(device->stat(*file));
  if (is_hidden(path)) return with_errno(-ENOENT);
  return real<int(const char*, struct stat*)>("stat")(path, file);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (const auto device = device_of(fd)) return with_errno(device->ioctl(fd, request, argument));
  return real<int(int, unsigned long, void*)>("ioctl")(fd, request, argument);
}

void* mmap(void* address, size_t length, int protection, int flags, int fd, off_t offset) noexcept {
  const auto device = fd >= 0 ? device_of(fd) : nullptr;
  const int file = device ? device->map(fd, length, offset) : fd;
  if (device && file < 0) {
    errno = -file;
    return reinterpret_cast<void*>(-1);  // MAP_FAILED
  }
  return real<void*(void*, size_t, int, int, int, off_t)>("mmap")(address, length, protection,
                                                                  flags, file, offset);
}

// The C library's declarations say that these two only write to `watched`.
int handcast_poll(pollfd* watched, nfds_t count, int span_ms) __asm__("poll");
int handcast_ppoll(pollfd* watched, nfds_t count, const timespec* span,
                   const sigset_t* mask) __asm__("ppoll");

int handcast_poll(pollfd* watched, nfds_t count, int span_ms) {
  if (const auto device = polled(watched, count)) {
    const timespec span{span_ms / 1000, span_ms % 1000 * 1'000'000};
    return poll_one(*device, *watched, span_ms < 0 ? nullptr : &span);
  }
  return real<int(pollfd*, nfds_t, int)>("poll")(watched, count, span_ms);
}

int handcast_ppoll(pollfd* watched, nfds_t count, const timespec* span, const sigset_t* mask) {
  if (const auto device = polled(watched, count)) return poll_one(*device, *watched, span);
  return real<int(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll")(watched, count, span,
                                                                               mask);
}
}
