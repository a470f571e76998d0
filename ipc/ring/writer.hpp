#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

class RingWriter;

/// A slot of shared memory, on loan to be filled in place. Published or given back (abandoned) exactly once.
template <class T>
class Loan {
 public:
  T& operator*() const { return *message_; }
  T* operator->() const { return message_; }
  explicit operator bool() const { return message_ != nullptr; }
  /// Bytes after T for messages with a tail.
  std::size_t tail_bytes() const { return tail_bytes_; }

  Loan(Loan&& other) noexcept;
  Loan& operator=(Loan&& other) noexcept;
  ~Loan();  ///< abandons what was not published

 private:
  template <class>
  friend class Writer;
  Loan(RingWriter* ring, T* message, std::size_t tail_bytes) : ring_(ring), message_(message), tail_bytes_(tail_bytes) {}
  RingWriter* ring_ = nullptr;
  T* message_ = nullptr;
  std::size_t tail_bytes_ = 0;
};

/// The one writer of a ring. Never blocks, never waits for a reader. One thread.
template <class T>
class Writer {
 public:
  /// Takes the ring's writer lock (released by the kernel when the process dies) and continues after the last message of a
  /// predecessor. Errors: bad_data (the ring is of another type), unavailable (another writer lives).
  static Result<Writer> attach(Segment segment);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// A slot with a default T in it. Empty (tests false) where every slot is leased: drop the own message.
  Loan<T> loan();
  /// Stamps header.published_ns and makes the message visible.
  void publish(Loan<T>&& loan);
  /// loan + copy + publish for small messages.
  void publish(const T& message);

  std::uint64_t published() const;  ///< by this writer
  std::uint64_t dropped() const;

 private:
  explicit Writer(std::unique_ptr<RingWriter> ring);
  std::unique_ptr<RingWriter> ring_;
};

}  // namespace handcast::ipc
