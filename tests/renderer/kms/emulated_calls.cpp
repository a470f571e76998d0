// SPDX-License-Identifier: Apache-2.0
// The system calls of this process. Those that do not concern the card go on to the C library.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>

#include <cerrno>
#include <cstdarg>
#include <string_view>

#include "tests/renderer/kms/emulated_kernel.hpp"

namespace {

using handcast::test::the_kernel;

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::shared_ptr<handcast::test::EmulatedCard::Kernel> kernel_of(int fd) {
  auto kernel = the_kernel();
  return kernel && kernel->owns(fd) ? kernel : nullptr;
}

int with_errno(int answer) {
  if (answer >= 0) return answer;
  errno = -answer;
  return -1;
}

int open_path(const char* function, const char* path, int flags, mode_t mode) {
  if (!std::string_view(path).starts_with("/dev/dri/"))
    return real<int(const char*, int, ...)>(function)(path, flags, mode);
  const auto kernel = the_kernel();
  return with_errno(kernel && std::string_view(path) == "/dev/dri/card0" ? kernel->open()
                                                                         : -ENOENT);
}

mode_t mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

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
  if (const auto kernel = kernel_of(fd)) kernel->close(fd);
  return real<int(int)>("close")(fd);
}

int ioctl(int fd, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (const auto kernel = kernel_of(fd)) return with_errno(kernel->ioctl(fd, request, argument));
  return real<int(int, unsigned long, void*)>("ioctl")(fd, request, argument);
}

void* mmap(void* address, size_t length, int protection, int flags, int fd, off_t offset) {
  const auto kernel = fd >= 0 ? kernel_of(fd) : nullptr;
  return real<void*(void*, size_t, int, int, int, off_t)>("mmap")(
      address, length, protection, flags, kernel ? kernel->memory() : fd, offset);
}
}
