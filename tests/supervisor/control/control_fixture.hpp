// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>

#include "ipc/control/control_client.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/control/control_server.hpp"
#include "tests/supervisor/scope_scratch.hpp"

namespace handcast::supervisor {

using namespace control;

/// A scope of the test's own, and a rig "desk" that answers in it.
class Control : public testing::Test {
 protected:
  void SetUp() override {
    loop_.watch(timer_.get(), [this] { drain(timer_.get()); });
  }

  void serve(ControlServer::OnRequest on_request) {
    auto server = ControlServer::listen("desk", loop_, std::move(on_request));
    ASSERT_TRUE(server) << server.error().what;
    server_ = std::move(*server);
  }

  /// What `client` returns, run beside the server.
  template <class Client>
  auto while_it_turns(Client client) {
    auto result = std::async(std::launch::async, client);
    while (result.wait_for(std::chrono::seconds(0)) != std::future_status::ready) loop_.turn();
    return result.get();
  }

  /// Connects to a rig; waits while the queue of its connections is full.
  static UniqueFd connect_patiently(const RigAddress& address) {
    for (;;) {
      auto socket = connect_to(address);
      if (socket || socket.error().code != Errc::timeout) return std::move(socket.value());
      usleep(1000);
    }
  }

  static std::size_t count_descriptors() {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
  }

  ScopeScratch scratch_;
  EventLoop loop_ = EventLoop::open().value();
  UniqueFd timer_ = open_timer(1'000'000).value();
  std::unique_ptr<ControlServer> server_;
};

}  // namespace handcast::supervisor
