#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/msg/header.hpp"

namespace handcast::ipc {

/// What a ring is made for. `payload_bytes` is the largest message, tail included.
struct RingSpec {
  std::string stream;               ///< "camera.frames"
  std::uint64_t type_hash = 0;      ///< msg::type_hash<T>()
  std::size_t payload_bytes = 0;
  int slots = 4;
  bool keep_history = false;        ///< reuse the oldest slot instead of the most recently freed: next() and at() see back

  template <class T>
  static RingSpec of(std::string stream, int slots, bool keep_history, std::size_t payload_bytes = sizeof(T)) {
    return {std::move(stream), msg::type_hash<T>(), payload_bytes, slots, keep_history};
  }
};

/// The shared memory of one ring: a sealed memfd (SHRINK | GROW), without a name anywhere. Made by the supervisor,
/// inherited by the services; mapped as long as the object lives.
class Segment {
 public:
  /// Makes, sizes, seals and formats the memory of a ring. Errors: unavailable (memory, descriptors), bad_config (sizes).
  static Result<Segment> create(const RingSpec& spec);
  /// Maps the ring behind a descriptor (which is taken over). Errors: bad_data with a sentence that says what differs:
  /// not a ring, other layout version, other boot, impossible sizes, unsealed.
  static Result<Segment> open(UniqueFd fd);

  Segment(Segment&&) noexcept;
  Segment& operator=(Segment&&) noexcept;
  ~Segment();

  int fd() const { return fd_.get(); }
  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::string stream() const;
  std::uint64_t type_hash() const;
  std::size_t payload_bytes() const;
  int slots() const;

 private:
  Segment(UniqueFd fd, std::byte* data, std::size_t size) : fd_(std::move(fd)), data_(data), size_(size) {}
  UniqueFd fd_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace handcast::ipc
