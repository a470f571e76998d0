// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string_view>

#include "ipc/msg/header.hpp"
#include "ipc/ring/reader.hpp"

namespace handcast::bench {

/// What is carried: `total_bytes` long, itself included; every word after it holds the frame's
/// number.
struct Block {
  static constexpr std::string_view layout = "Block/1";
  msg::Header header;  ///< origin: the payload is complete (ready); published: the producer's last
                       ///< stamp before it sends
  std::uint64_t total_bytes = sizeof(Block);

  std::uint64_t* words() { return reinterpret_cast<std::uint64_t*>(this + 1); }
  const std::uint64_t* words() const { return reinterpret_cast<const std::uint64_t*>(this + 1); }
  std::size_t word_count() const { return (total_bytes - sizeof(Block)) / sizeof(std::uint64_t); }
  std::size_t used_bytes() const { return total_bytes; }
};

/// Everything but the stamps.
void fill(Block& block, std::uint64_t number, std::size_t bytes);
/// Reads every byte.
std::uint64_t sum(const Block& block);

/// Fills the block of this number and sends it.
using Send = std::function<void(std::uint64_t number)>;
/// Waits for the next block and shows it. False: none came within two seconds.
using Take = std::function<bool(const std::function<void(const Block&)>& look)>;

/// One way to carry blocks between two processes. Each end is opened by the process that uses it,
/// the receiving one first.
struct Transport {
  std::function<Send()> open_sender;
  std::function<Take()> open_receiver;
};

/// A ring as the rig has it for its images: eight slots, the newest message counts.
Transport over_ring(std::size_t bytes, ipc::Wait wait, ipc::Hold hold);
/// SOCK_SEQPACKET; a stream where the kernel takes no packet of that size.
Transport over_socket(std::size_t bytes);
/// ZeroMQ PUSH/PULL over ipc, its messages filled in place.
Transport over_zeromq(std::size_t bytes);

/// A benchmark that cannot measure says why and ends.
[[noreturn]] void give_up(std::string_view why);

template <class T>
T must(Result<T> result) {
  if (!result) give_up(result.error().what);
  return std::move(*result);
}

/// The same memory mapped once more, as another process has it.
ipc::Segment again(const ipc::Segment& segment);

}  // namespace handcast::bench
