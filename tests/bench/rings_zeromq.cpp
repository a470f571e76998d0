// SPDX-License-Identifier: Apache-2.0
// The only file that knows ZeroMQ.
#include <fmt/format.h>
#include <unistd.h>
#include <zmq.h>

#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

constexpr int kPatience_ms = 2000;

/// A socket with the context it lives in; closing waits until everything is sent.
class ZeroMqSocket {
 public:
  explicit ZeroMqSocket(int type) : context_(zmq_ctx_new()), socket_(zmq_socket(context_, type)) {
    if (!socket_) give_up(zmq_strerror(zmq_errno()));
    for (const int option : {ZMQ_LINGER, ZMQ_RCVTIMEO, ZMQ_SNDTIMEO})
      zmq_setsockopt(socket_, option, &kPatience_ms, sizeof kPatience_ms);
  }
  ~ZeroMqSocket() {
    zmq_close(socket_);
    zmq_ctx_term(context_);
  }
  ZeroMqSocket(const ZeroMqSocket&) = delete;

  void* get() const { return socket_; }

 private:
  void* context_;
  void* socket_;
};

void check(bool worked) {
  if (!worked) give_up(fmt::format("ZeroMQ: {}", zmq_strerror(zmq_errno())));
}

}  // namespace

Transport over_zeromq(std::size_t bytes) {
  static int number_of_endpoint = 0;
  const auto endpoint = fmt::format("ipc://@handcast-bench-{}-{}", ::getpid(),
                                    ++number_of_endpoint);  // '@': a name without a file
  const auto open_sender = [=]() -> Send {
    const auto socket = std::make_shared<ZeroMqSocket>(ZMQ_PUSH);
    check(zmq_connect(socket->get(), endpoint.c_str()) == 0);
    return [=](std::uint64_t number) {
      zmq_msg_t message;
      check(zmq_msg_init_size(&message, bytes) == 0);
      auto& block = *static_cast<Block*>(zmq_msg_data(&message));
      fill(block, number, bytes);
      block.header.origin_ns = block.header.published_ns = now_ns();
      check(zmq_msg_send(&message, socket->get(), 0) >= 0);
    };
  };
  const auto open_receiver = [=]() -> Take {
    const auto socket = std::make_shared<ZeroMqSocket>(ZMQ_PULL);
    check(zmq_bind(socket->get(), endpoint.c_str()) == 0);
    return [=](const auto& look) {
      zmq_msg_t message;
      zmq_msg_init(&message);
      const bool came = zmq_msg_recv(&message, socket->get(), 0) >= 0;
      if (came) look(*static_cast<const Block*>(zmq_msg_data(&message)));
      zmq_msg_close(&message);
      return came;
    };
  };
  return {open_sender, open_receiver};
}

}  // namespace handcast::bench
