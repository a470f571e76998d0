// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <fstream>

#include "ipc/base/clock.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/life/service.hpp"

namespace handcast::supervisor {

/// A service whose program is a shell script of the test.
class ServiceTest : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/handcast-service-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    launch_.program_folder = name;
    launch_.stop_s = 0.2;
    launch_.ready_s = 20;
    launch_.keeper = &keeper_;
    timer_ = open_timer(5'000'000).value();
    loop_.watch(timer_.get(), [this] {
      drain(timer_.get());
      for (const auto& service : services_) service->tick(now_ns(), look());
      ++ticks_;
    });
  }
  void TearDown() override {
    while (!services_.empty()) services_.pop_back();  // those that adopted a process first
    std::filesystem::remove_all(launch_.program_folder);
  }

  Service& service(const std::string& script) {
    const auto program = launch_.program_folder / "handcast-pose";
    std::ofstream(program) << "#!/bin/bash\n" << script << "\n";
    chmod(program.c_str(), 0755);
    services_.push_back(std::make_unique<Service>(
        ServiceSpec{.name = "pose", .stream = "pose.hands", .backend = "twin", .process = process_},
        launch_, loop_, [this](Service&, Notice notice) { notices_.push_back(notice); }));
    return *services_.back();
  }
  /// A service that takes over the process of `first`.
  Service& adopting(const Service& first, const std::string& script, int restarts) {
    AdoptedProcess process{.saved = first.saved(), .pidfd = open_pidfd(first.pid()), .log = {}};
    process.saved.restarts = restarts;
    auto& second = service(script);
    second.inherit(process.saved);
    second.adopt(std::move(process));
    return second;
  }
  Service::Look look() const {
    return {.needs_are_ready = needs_are_ready_, .last_sign_ns = now_ns()};
  }
  void run_until(const std::function<bool()>& done) {
    const auto limit = Deadline::in(std::chrono::seconds(30));
    while (!done() && !limit.passed()) loop_.turn();
    ASSERT_TRUE(done());
  }

  EventLoop loop_ = EventLoop::open().value();
  UniqueFd timer_;
  KeeperLink keeper_ = KeeperLink::from_environment();
  Launch launch_;
  config::Process process_;
  std::vector<std::unique_ptr<Service>> services_;
  std::vector<Notice> notices_;
  bool needs_are_ready_ = true;
  int ticks_ = 0;
};

/// A script that is ready at once and works until it is stopped.
inline constexpr auto kWorks = "echo >&$HANDCAST_READY_FD; exec sleep 1000";

}  // namespace handcast::supervisor
