// SPDX-License-Identifier: Apache-2.0
// Clients that want to harm.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <atomic>
#include <fstream>

#include "services/desk/page/http_server.hpp"
#include "tests/services/desk/page/open_page.hpp"

namespace handcast::test {
namespace {

using control::Role;

int thread_count() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "Threads:") {
      int count = 0;
      status >> count;
      return count;
    }
  return 0;
}

TEST_F(PageTest, ABodyOfAGigabyteIsRefusedBeforeItComes) {
  Wire wire(port_);
  wire.send(
      fmt::format("POST /api/set HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\n"
                  "Content-Type: application/json\r\nContent-Length: 1073741824\r\n\r\n",
                  port_, address_.tokens[2]));
  EXPECT_EQ(parse_answer(wire.receive()).status, 413);
  EXPECT_TRUE(wire.is_closed());
}

TEST_F(PageTest, ABodyWithoutEndIsCutOff) {
  Wire wire(port_);
  wire.send(
      fmt::format("POST /api/set HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\n"
                  "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n",
                  port_, address_.tokens[2]));
  const auto chunk = "1000\r\n" + std::string(0x1000, ' ') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{64} << 20) && wire.send(chunk)) sent += chunk.size();
  EXPECT_LT(sent, std::size_t{64} << 20);
}

TEST_F(PageTest, AHeaderWithoutEndIsCutOff) {
  Wire wire(port_);
  wire.send("GET / HTTP/1.1\r\n");
  const std::string line = "X-Padding: " + std::string(1000, 'a') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{64} << 20) && wire.send(line)) sent += line.size();
  EXPECT_LT(sent, std::size_t{64} << 20);
  EXPECT_EQ(ask(port_, "GET", "/").status, 200);
}

TEST_F(PageTest, BytesThatAreNoRequestAreNoHarm) {
  for (const std::string& bytes :
       {std::string("\r\n\r\n\r\n"), std::string(5000, '\0'),
        std::string("\x16\x03\x01\x02\x00\x01", 6), std::string("GET\r\n\r\n"),
        std::string("POST /api/set HTTP/9.9\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost\r\n\r\n"),
        std::string("POST /api/set HTTP/1.1\r\nContent-Length: -1\r\n\r\n"),
        std::string("POST /api/set HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"),
        std::string("POST /api/set HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\n"),
        std::string(
            "POST /x HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n")}) {
    Wire wire(port_);
    wire.send(bytes);
    wire.receive("HTTP/1.1", 0, std::chrono::seconds(1));
  }
  EXPECT_EQ(ask(port_, "GET", "/").status, 200);
  EXPECT_TRUE(panel_.sets.empty());
}

TEST_F(PageTest, JsonThatMakesNoSenseIsRefusedWithASentence) {
  for (const std::string body :
       {"", "{", "[]", "null", "17", "\"set\"", "{}", R"({"set":[]})", R"({"set":"a=1"})",
        R"({"set":[1]})", R"({"set":[["a"]]})", R"({"set":{"a":1}})", "{\"set\":[\"\xff\xfe\"]}"}) {
    const auto answer = post("/api/set", body, Role::owner);
    EXPECT_EQ(answer.status / 100, 4) << body;
    EXPECT_THAT(answer.body, testing::StartsWith(R"({"error":")")) << body;
  }
  EXPECT_EQ(post("/api/set", std::string(60'000, '['), Role::owner).status, 400);
  EXPECT_EQ(post("/api/set", R"({"set":["no.such=1"]})", Role::owner).status, 422);
  EXPECT_EQ(post("/api/set", R"({"set":["projector.brightness=7"]})", Role::owner).status, 422);
  EXPECT_EQ(post("/api/cue", R"({"do":"jump","cue":1})", Role::owner).status, 400);
  EXPECT_EQ(post("/api/cue", R"({"do":"jump","cue":"999"})", Role::owner).status, 422);
  EXPECT_EQ(post("/api/show", R"({"hand":"third","content":"wave"})", Role::owner).status, 400);
  EXPECT_TRUE(panel_.sets.empty());
  EXPECT_TRUE(panel_.shown.empty());
}

TEST_F(PageTest, AFormIsNoRequest) {
  Wire wire(port_);
  wire.send(
      fmt::format("POST /api/set HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\n"
                  "Content-Type: text/plain\r\nContent-Length: 2\r\n\r\n{{}}",
                  port_, address_.tokens[2]));
  EXPECT_EQ(parse_answer(wire.receive()).status, 415);
}

TEST_F(PageTest, ThousandChangesAtOnceAreTooMany) {
  int refused = 0;
  for (int i = 0; i < 1500; ++i) refused += post("/api/undo", "{}", Role::operator_).status == 429;
  // As many as a machine sends in the time that refills the bucket are none: a slow one sends no
  // more than it takes.
  if (refused == 0) GTEST_SKIP() << "this machine is too slow to send that many";
  EXPECT_EQ(ask_again(port_, "GET", "/").status, 200);
}

TEST_F(PageTest, SixteenPagesAreTheMost) {
  std::vector<std::unique_ptr<Wire>> pages;
  for (int i = 0; i < 16; ++i)
    pages.push_back(stream("/api/events", Role::viewer, "event: values"));
  EXPECT_EQ(ask(port_, "GET", "/api/events", as(Role::viewer)).status, 503);
  pages.pop_back();
  // The server notices with the next event that it cannot send.
  for (int i = 0; i < 200; ++i) {
    Wire wire(port_);
    wire.send(request_text(port_, "GET", "/api/events", as(Role::viewer)));
    if (parse_answer(wire.receive("\r\n\r\n")).status == 200) return;
    sleep_until_ns(now_ns() + 50'000'000);
  }
  FAIL() << "the place of a page that was closed is not free";
}

TEST_F(PageTest, ManyIdleConnectionsTakeFewThreadsAndOpenPagesGoOn) {
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  rlimit more = files;
  more.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &more);
  const auto count = std::min<std::size_t>(10'000, more.rlim_cur > 400 ? more.rlim_cur - 400 : 0);
  const auto events = stream("/api/events", Role::viewer, "event: values");
  {
    std::vector<std::unique_ptr<Wire>> idle;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 3'000); ++i)
      idle.push_back(std::make_unique<Wire>(port_));
    EXPECT_LE(thread_count(), 80);
    const std::string before = events->receive("event: values");
    ASSERT_TRUE(panel_.set(std::vector<std::string>{"projector.fill.cells=9"}, "test"));
    EXPECT_THAT(events->receive("\"projector.fill.cells\":\"9\"", before.size()),
                testing::HasSubstr("\"projector.fill.cells\":\"9\""));
  }
  EXPECT_EQ(ask_again(port_, "GET", "/").status, 200);
  ::setrlimit(RLIMIT_NOFILE, &files);
}

desk::HttpLimits impatient() {
  desk::HttpLimits limits;
  limits.connections = 4;
  limits.request_ns = 300'000'000;
  return limits;
}

TEST(HttpServer, OneByteAtATimeIsTooSlowForAHeaderAndForABody) {
  const auto server = desk::HttpServer::open(
      "127.0.0.1", 0, [](const desk::HttpRequest&) { return desk::HttpAnswer{}; }, impatient());
  ASSERT_TRUE(server) << server.error().what;
  for (const auto* start :
       {"GET / HTTP/1.1\r\nX: ", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 60000\r\n\r\n"}) {
    Wire wire((*server)->port());
    wire.send(start);
    bool is_open = true;
    for (int i = 0; i < 2000 && is_open; ++i) {
      sleep_until_ns(now_ns() + 10'000'000);
      is_open = wire.send("a");
    }
    EXPECT_FALSE(is_open) << start;
    EXPECT_EQ(ask((*server)->port(), "GET", "/").status, 200);
  }
}

TEST(HttpServer, ThoseWhoAskComeThroughACrowdThatDoesNot) {
  auto limits = impatient();
  limits.request_ns = 3'600'000'000'000;
  const auto server = desk::HttpServer::open(
      "127.0.0.1", 0, [](const desk::HttpRequest&) { return desk::HttpAnswer{}; }, limits);
  ASSERT_TRUE(server);
  std::vector<std::unique_ptr<Wire>> crowd;
  for (int i = 0; i < 40; ++i) crowd.push_back(std::make_unique<Wire>((*server)->port()));
  // At the limit, others are turned away at once; they ask again, as the page does.
  int status = 0;
  for (int i = 0; i < 1000 && status == 0; ++i) {
    status = ask((*server)->port(), "GET", "/").status;
    sleep_until_ns(now_ns() + 10'000'000);
  }
  EXPECT_EQ(status, 200);
}

TEST(HttpServer, AClientThatConnectsTooOftenIsTurnedAwayForAWhile) {
  desk::HttpLimits limits;
  limits.connections_at_once = 20;
  limits.connections_hz = 50;
  std::atomic<int> answered = 0;
  const auto server = desk::HttpServer::open(
      "127.0.0.1", 0,
      [&](const desk::HttpRequest&) {
        ++answered;
        return desk::HttpAnswer{};
      },
      limits);
  ASSERT_TRUE(server);
  const auto begin_ns = now_ns();
  for (int i = 0; i < 400; ++i) ask((*server)->port(), "GET", "/");
  EXPECT_LE(answered, 20 + 50 * ns_to_seconds(now_ns() - begin_ns) + 1);
  EXPECT_GE(answered, 20);
  EXPECT_EQ(ask_again((*server)->port(), "GET", "/").status, 200);
}

TEST(HttpServer, APortThatIsTakenIsASentence) {
  const auto handler = [](const desk::HttpRequest&) { return desk::HttpAnswer{}; };
  const auto first = desk::HttpServer::open("127.0.0.1", 0, handler);
  ASSERT_TRUE(first);
  const auto second = desk::HttpServer::open("127.0.0.1", (*first)->port(), handler);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::unavailable);
}

}  // namespace
}  // namespace handcast::test
