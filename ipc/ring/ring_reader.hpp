#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/ring/buffer_pool.hpp"
#include "ipc/ring/message.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/rhythm.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// How a reader waits for the next message.
enum class Wait {
  spin,        ///< seen within 1 us, for a whole core
  predictive,  ///< sleeps until shortly before a regular stream's next message is due: nearly as fast, for some 5 % of a core
  futex,       ///< is woken: 30-60 us
};

/// What every Reader<T> is made of: the protocol on a mapped segment, messages as bytes.
class RingReader {
 public:
  static Result<std::unique_ptr<RingReader>> attach(Segment segment, const MessageShape& shape, Wait wait);
  ~RingReader();
  RingReader(const RingReader&) = delete;
  RingReader& operator=(const RingReader&) = delete;

  struct Message {
    std::shared_ptr<std::byte> memory;
    std::uint64_t sequence = 0;
    std::uint64_t epoch = 0;
  };
  Result<Message> next(Deadline deadline);
  Result<Message> latest(Deadline deadline);
  Result<Message> at(std::int64_t origin_ns);

  std::uint64_t received() const { return received_; }
  std::uint64_t skipped() const { return core_.skipped() + unusable_; }

 private:
  RingReader(Segment segment, const MessageShape& shape, Wait wait, int row, std::uint64_t owner);

  template <class Take>
  Result<Message> take_until(Deadline deadline, Take take);
  std::size_t copy_out(int slot, std::byte* to) const;
  Result<Message> checked(std::shared_ptr<std::byte> memory, const Taken& taken, std::size_t claimed_bytes) const;
  void wait(Deadline deadline);
  void spin(std::int64_t until_ns) const;
  tl::unexpected<Error> fail_here(Errc code, std::string_view what) const;

  Segment segment_;
  MessageShape shape_;
  Wait wait_;
  int row_;
  std::uint64_t owner_;
  ReaderCore<RealAtomics> core_;
  BufferPool pool_;
  Rhythm rhythm_;
  std::uint64_t received_ = 0;
  std::uint64_t unusable_ = 0;
};

}  // namespace handcast::ipc
