// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include "supervisor/look/top/top_look.hpp"
#include "tests/supervisor/control/control_fixture.hpp"

namespace handcast::supervisor {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

void refuse(const Request&, const ControlServer::Reply& reply) { reply(failure("no")); }

TEST_F(Control, AClientGetsTheAnswerToItsRequest) {
  serve([](const Request& request, const ControlServer::Reply& reply) {
    auto answer = success();
    answer["echo"] = request.service;
    reply(answer);
  });
  const auto answer = while_it_turns([] { return ask("desk", {Verb::restart, "pose", ""}); });
  ASSERT_TRUE(answer);
  EXPECT_EQ((*answer)["echo"], "pose");
}

TEST_F(Control, ARefusalIsTheServersSentence) {
  serve(refuse);
  const auto answer = while_it_turns([] { return ask("desk", {}); });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().what, "no");
}

TEST_F(Control, AnAnswerLargerThanTheSocketsBufferArrivesWhole) {
  const std::string text(3'000'000, 'x');
  serve([&](const Request&, const ControlServer::Reply& reply) {
    auto answer = success();
    answer["text"] = text;
    reply(answer);
  });
  const auto answer = while_it_turns([] { return ask("desk", {}); });
  ASSERT_TRUE(answer) << answer.error().what;
  EXPECT_EQ((*answer)["text"], text);
}

TEST_F(Control, AClientThatDoesNotReadIsDroppedAndTheOthersAreServed) {
  int answers = 0;
  serve([&](const Request&, const ControlServer::Reply& reply) {
    ++answers;
    auto answer = success();
    answer["text"] = std::string(1'000'000, 'x');
    reply(answer);
  });
  const auto lazy = connect_to(address_of("desk").value()).value();
  const std::string requests = to_line({{"verb", "status"}}) + "\n";
  for (int i = 0; i < 8; ++i)
    ASSERT_EQ(send(lazy.get(), requests.data(), requests.size(), MSG_NOSIGNAL), requests.size());
  EXPECT_TRUE(while_it_turns([] { return ask("desk", {}); }));
  EXPECT_LT(answers, 9);  // those in the socket's buffer and in the server's
  pollfd hung_up{.fd = lazy.get(), .events = 0, .revents = 0};
  EXPECT_EQ(poll(&hung_up, 1, 0), 1);
  EXPECT_TRUE(hung_up.revents & POLLHUP);
}

/// A memory file with something in it.
UniqueFd memory_with(char content) {
  UniqueFd file(memfd_create("test", MFD_CLOEXEC));
  EXPECT_EQ(pwrite(file.get(), &content, 1, 0), 1);
  return file;
}

char content_of(const UniqueFd& file) {
  char content = 0;
  EXPECT_EQ(pread(file.get(), &content, 1, 0), 1);
  return content;
}

TEST_F(Control, DescriptorsComeWithTheAnswerInTheirOrderAndAreNotInherited) {
  const auto left = memory_with('l'), right = memory_with('r');
  serve([&](const Request&, const ControlServer::Reply& reply) {
    auto answer = success();
    answer["rings"] = {"left", "right"};
    reply(answer, {left.get(), right.get()});
  });
  const auto answer =
      while_it_turns([] { return ask_with_descriptors("desk", {.verb = Verb::rings}); });
  ASSERT_TRUE(answer) << answer.error().what;
  ASSERT_EQ(answer->descriptors.size(), 2);
  EXPECT_EQ(content_of(answer->descriptors[0]), 'l');
  EXPECT_EQ(content_of(answer->descriptors[1]), 'r');
  for (const auto& fd : answer->descriptors) EXPECT_TRUE(fcntl(fd.get(), F_GETFD) & FD_CLOEXEC);
}

TEST_F(Control, AsManyDescriptorsAsTheKernelAllowsArriveAndMoreAreNotSent) {
  const auto file = memory_with('x');
  std::size_t count = kMostDescriptors;
  serve([&](const Request&, const ControlServer::Reply& reply) {
    auto answer = success();
    answer["rings"] = std::vector<std::string>(count, "ring");
    answer["text"] = std::string(
        1'000'000, 'x');  // descriptors also come with an answer that does not fit at once
    reply(answer, std::vector<int>(count, file.get()));
  });
  const auto all =
      while_it_turns([] { return ask_with_descriptors("desk", {.verb = Verb::rings}); });
  ASSERT_TRUE(all) << all.error().what;
  EXPECT_EQ(all->descriptors.size(), kMostDescriptors);
  ++count;
  const auto too_many =
      while_it_turns([] { return ask_with_descriptors("desk", {.verb = Verb::rings}); });
  ASSERT_FALSE(too_many);
  EXPECT_THAT(too_many.error().what, HasSubstr("went away"));
}

TEST_F(Control, DescriptorsThatNobodyAskedForAreClosed) {
  const auto file = memory_with('x');
  serve([&](const Request&, const ControlServer::Reply& reply) {
    reply(success(), {file.get(), file.get()});
  });
  const auto before = count_descriptors();
  const auto answer = while_it_turns([] {
    return ask_with_descriptors(
        "desk", {.verb = Verb::history, .service = {}, .backend = {}, .seconds = 1});
  });
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->descriptors.size(), 1);
  EXPECT_TRUE(while_it_turns([] { return ask("desk", {}); }));
  for (int turns = 0; count_descriptors() > before + 1 && turns < 1000; ++turns)
    loop_.turn();  // the server handles the hang-up
  EXPECT_LE(count_descriptors(), before + 1);
}

TEST_F(Control, ASupervisorThatHangsIsTold) {
  serve(refuse);  // and the loop does not turn
  for (const auto verb : {Verb::status, Verb::down}) {
    const auto answer = ask_with_descriptors("desk", {.verb = verb}, 50ms);
    ASSERT_FALSE(answer);
    EXPECT_THAT(answer.error().what, HasSubstr("its supervisor hangs"));
  }
}

TEST_F(Control, WhoLooksOnDoesNotWaitLongForASupervisorThatHangs) {
  serve(refuse);  // and the loop does not turn
  EXPECT_THAT(RigWatcher("desk").observe().missing, HasSubstr("has not answered for 1 s"));
}

TEST_F(Control, WhatTakesLongIsWaitedForWhileTheSupervisorIsAwake) {
  ControlServer::Reply later;
  int asked_meanwhile = 0;
  serve([&](const Request& request, const ControlServer::Reply& reply) {
    if (request.verb == Verb::down) later = reply;
    if (request.verb == Verb::status) reply(success());
    if (request.verb == Verb::status && ++asked_meanwhile == 3) later(success());
  });
  EXPECT_TRUE(
      while_it_turns([] { return ask_with_descriptors("desk", {.verb = Verb::down}, 50ms); }));
  EXPECT_EQ(asked_meanwhile, 3);
}

TEST_F(Control, ClientsThatAskNothingDoNotShutOthersOut) {
  serve([](const Request&, const ControlServer::Reply& reply) { reply(success()); });
  const auto address = address_of("desk").value();
  std::vector<UniqueFd> idle;
  while_it_turns([&] {
    while (idle.size() < 200) idle.push_back(connect_patiently(address));
    return 0;
  });
  EXPECT_TRUE(while_it_turns([] { return ask("desk", {}); }));
}

TEST_F(Control, ManyThatComeAtOnceAreAllAnswered) {
  serve([](const Request&, const ControlServer::Reply& reply) { reply(success()); });
  const auto address = address_of("desk").value();
  const auto line = print_request(Request{}) + "\n";
  std::vector<UniqueFd> clients;
  for (int i = 0; i < 120; ++i) {  // the loop does not turn yet
    auto socket = connect_to(address);
    ASSERT_TRUE(socket) << i << ": " << socket.error().what;
    ASSERT_EQ(send(socket->get(), line.data(), line.size(), 0), std::ssize(line));
    clients.push_back(std::move(*socket));
  }
  EXPECT_TRUE(while_it_turns([] { return ask("desk", {}); }));  // the last one
  for (const auto& client : clients) {
    char first = 0;
    EXPECT_EQ(recv(client.get(), &first, 1, MSG_DONTWAIT), 1);
  }
}

TEST_F(Control, AClientThatWaitsForItsAnswerIsKeptWhenOthersComeIn) {
  std::optional<ControlServer::Reply> down;
  std::atomic<bool> is_waiting = false;
  serve([&](const Request& request, ControlServer::Reply reply) {
    if (request.verb == Verb::down) {
      down = std::move(reply);
      is_waiting = true;
      return;
    }
    (*down)(success());
    reply(success());
  });
  const auto answered = while_it_turns([&] {
    auto answer = std::async(std::launch::async, [] {
      return ask_with_descriptors("desk", {.verb = Verb::down}, 20s).has_value();
    });
    while (!is_waiting) usleep(1000);
    std::vector<UniqueFd> idle;
    const auto address = address_of("desk").value();
    while (idle.size() < 100) idle.push_back(connect_patiently(address));
    EXPECT_TRUE(ask("desk", {}));
    return answer.get();
  });
  EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace handcast::supervisor
