// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <unistd.h>

#include <utility>

namespace handcast {

/// Owns a file descriptor and closes it on destruction. Movable, not copyable.
class UniqueFd {
 public:
  UniqueFd() = default;
  /// Takes ownership of `fd`; a negative one means none.
  explicit UniqueFd(int fd) : fd_(fd) {}
  /// Takes the descriptor of `other`, which is empty afterwards. Assignment closes the old one.
  /// @{
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    if (this != &other) reset(std::exchange(other.fd_, -1));
    return *this;
  }
  /// @}
  ~UniqueFd() { reset(); }

  /// The descriptor, still owned by this object; -1 if it is empty.
  int get() const { return fd_; }
  /// True if this object owns a descriptor.
  explicit operator bool() const { return fd_ >= 0; }
  /// Returns the descriptor and gives up ownership: the caller must close it.
  int release() { return std::exchange(fd_, -1); }
  /// Closes the descriptor, if there is one, and takes ownership of `fd`.
  void reset(int fd = -1) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_ = -1;
};

}  // namespace handcast
