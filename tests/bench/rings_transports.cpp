// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_transports.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "ipc/ring/writer.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 2s;
constexpr int kSlots = 8;

using Reader = ipc::Reader<Block>;

/// As a program does that waits for many things at once.
Result<ipc::Sample<Block>> next_by_event(Reader& reader) {
  const auto deadline = Deadline::in(kPatience);
  for (;;) {
    auto block = reader.next(Deadline::now());
    if (block || deadline.passed()) return block;
    pollfd event{reader.event_fd(), POLLIN, 0};
    ::poll(&event, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count()));
  }
}

struct Sockets {
  UniqueFd sender, receiver;
};

Sockets open_sockets(int type, std::size_t bytes) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, type, 0, ends.data()) != 0) give_up("no socket pair");
  const int room = static_cast<int>(bytes * 4);
  if (::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUFFORCE, &room, sizeof room) != 0)
    ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
  const timeval patience{std::chrono::seconds(kPatience).count(), 0};
  ::setsockopt(ends[1], SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  return {UniqueFd(ends[0]), UniqueFd(ends[1])};
}

/// Sockets that keep messages whole, if the kernel has room for such a message.
Sockets sockets_for(std::size_t bytes) {
  auto sockets = open_sockets(SOCK_SEQPACKET, bytes);
  std::vector<std::byte> probe(bytes);
  const bool fits = ::send(sockets.sender.get(), probe.data(), bytes, MSG_DONTWAIT) ==
                    static_cast<ssize_t>(bytes);
  if (fits && ::recv(sockets.receiver.get(), probe.data(), bytes, 0) > 0) return sockets;
  return open_sockets(SOCK_STREAM, bytes);
}

void send_all(int socket, const std::byte* from, std::size_t bytes) {
  for (std::size_t done = 0; done < bytes;) {
    const auto sent = ::send(socket, from + done, bytes - done, MSG_NOSIGNAL);
    if (sent <= 0) give_up("the socket's other end is gone");
    done += static_cast<std::size_t>(sent);
  }
}

bool receive_all(int socket, std::byte* to, std::size_t bytes) {
  for (std::size_t done = 0; done < bytes;) {
    const auto got = ::recv(socket, to + done, bytes - done, 0);
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

/// Memory of a process of its own for one block.
class PrivateBlock {
 public:
  explicit PrivateBlock(std::size_t bytes)
      : memory_(std::make_shared<std::vector<std::uint64_t>>(bytes / sizeof(std::uint64_t))) {}
  Block& operator*() const { return *reinterpret_cast<Block*>(memory_->data()); }
  std::byte* bytes() const { return reinterpret_cast<std::byte*>(memory_->data()); }

 private:
  std::shared_ptr<std::vector<std::uint64_t>> memory_;
};

}  // namespace

void give_up(std::string_view why) {
  fmt::print(stderr, "{}: {}\n", program_invocation_short_name, why);
  std::exit(1);
}

void fill(Block& block, std::uint64_t number, std::size_t bytes) {
  block.header.frame_id = number;
  block.total_bytes = bytes;
  std::fill_n(block.words(), block.word_count(), number);
}

std::uint64_t sum(const Block& block) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < block.word_count(); ++i) total += block.words()[i];
  return total;
}

ipc::Segment again(const ipc::Segment& segment) {
  return must(ipc::Segment::open(UniqueFd(::dup(segment.fd()))));
}

Transport over_ring(std::size_t bytes, ipc::Wait wait, ipc::Hold hold) {
  const auto segment = std::make_shared<ipc::Segment>(
      must(ipc::Segment::create(ipc::RingSpec::of<Block>("bench", kSlots, false, bytes))));
  const auto open_sender = [=]() -> Send {
    const auto writer =
        std::make_shared<ipc::Writer<Block>>(must(ipc::Writer<Block>::attach(again(*segment))));
    return [=](std::uint64_t number) {
      auto block = writer->loan();
      if (!block) return;
      fill(*block, number, bytes);
      block->header.origin_ns = now_ns();
      writer->publish(std::move(block));
    };
  };
  const auto open_receiver = [=]() -> Take {
    const auto reader = std::make_shared<Reader>(must(Reader::attach(again(*segment), wait, hold)));
    return [=](const auto& look) {
      const auto block = wait == ipc::Wait::eventfd && reader->event_fd() >= 0
                             ? next_by_event(*reader)
                             : reader->next(Deadline::in(kPatience));
      if (block) look(**block);
      return block.has_value();
    };
  };
  return {open_sender, open_receiver};
}

Transport over_socket(std::size_t bytes) {
  const auto sockets = std::make_shared<Sockets>(sockets_for(bytes));
  const auto open_sender = [=]() -> Send {
    return [=, block = PrivateBlock(bytes)](std::uint64_t number) {
      fill(*block, number, bytes);
      (*block).header.origin_ns = (*block).header.published_ns = now_ns();
      send_all(sockets->sender.get(), block.bytes(), bytes);
    };
  };
  const auto open_receiver = [=]() -> Take {
    return [=, block = PrivateBlock(bytes)](const auto& look) {
      if (!receive_all(sockets->receiver.get(), block.bytes(), bytes)) return false;
      look(*block);
      return true;
    };
  };
  return {open_sender, open_receiver};
}

}  // namespace handcast::bench
