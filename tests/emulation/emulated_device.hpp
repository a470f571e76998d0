// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

/// @file
/// Devices whose kernel part is emulated: system_calls.cpp takes the place of open(), close(),
/// stat(), ioctl(), mmap() and poll() of this process, and asks these objects. Compile it into one
/// shared library with the devices; its calls then come before those of the C library, also in a
/// process that preloads it.

namespace handcast::test {

/// The kernel's part of a device file. Methods return what the system call does, or -errno. Any
/// thread.
class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;

  /// Whether the device file is there.
  virtual bool is_at(std::string_view path) const = 0;
  /// A descriptor, which the caller of the system call owns.
  virtual int open() = 0;
  virtual bool owns(int fd) const = 0;
  /// Before the descriptor is closed. Not by close(), which would ask this object.
  virtual void close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// The file whose part at `offset` is mapped instead.
  virtual int map(int fd, std::size_t length, std::int64_t offset) = 0;
  /// By default, a device that the group `video` may use.
  virtual int stat(struct stat& file) const;
  /// Whether poll() is asked. Otherwise the descriptor is polled as what it is.
  virtual bool answers_polls() const { return false; }
  /// poll() for one descriptor: waits until `until_ns` (CLOCK_MONOTONIC), at most, and returns the
  /// events; 0 in the end.
  virtual short poll(int fd, short events, std::int64_t until_ns);
};

/// From now on, the machine's own files whose names begin like this are not there.
void hide(std::string_view beginning);

/// Adds a device, or takes it away.
/// @{
void attach(std::shared_ptr<EmulatedDevice> device);
void detach(const EmulatedDevice* device);
/// @}

}  // namespace handcast::test
