// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/metrics/http_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::string_view kScrape = "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n";

UniqueFd connected(int port) {
  UniqueFd client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_in address{.sin_family = AF_INET,
                            .sin_port = htons(static_cast<std::uint16_t>(port)),
                            .sin_addr = {htonl(INADDR_LOOPBACK)},
                            .sin_zero = {}};
  EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address),
            0);
  const timeval hang{.tv_sec = 20, .tv_usec = 0};  // ends the test, not the connection
  ::setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &hang, sizeof hang);
  return client;
}

void say(const UniqueFd& client, std::string_view text) {
  ::send(client.get(), text.data(), text.size(), MSG_NOSIGNAL);
}

/// Everything until the server closes the connection. "hang" at its end: the server did not.
std::string heard(const UniqueFd& client) {
  std::string text;
  std::array<char, 65536> bytes;
  for (;;) {
    const auto count = ::recv(client.get(), bytes.data(), bytes.size(), 0);
    if (count <= 0) return count == 0 || errno == ECONNRESET ? text : text + "hang";
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

std::string answer_to(int port, std::string_view request) {
  const auto client = connected(port);
  say(client, request);
  return heard(client);
}

class HttpWithPatience : public ::testing::Test {
 protected:
  explicit HttpWithPatience(std::int64_t patience_ns)
      : server_(HttpServer::listen(
                    0, [this] { return ++asked_, body_; }, patience_ns)
                    .value()),
        port_(server_.port()) {}

  std::atomic<int> asked_{0};
  std::string body_ = "up 1\n";
  HttpServer server_;
  int port_;
};

/// A server that never closes a connection early.
struct Http : HttpWithPatience {
  Http() : HttpWithPatience(3'600'000'000'000) {}
};
/// A server that closes slow connections soon.
struct HastyHttp : HttpWithPatience {
  HastyHttp() : HttpWithPatience(500'000'000) {}
};

TEST_F(Http, AScrapeGetsTheTextAndItsLength) {
  EXPECT_THAT(answer_to(port_, kScrape),
              AllOf(StartsWith("HTTP/1.1 200 OK\r\n"),
                    HasSubstr("\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\n"),
                    HasSubstr("\r\nContent-Length: 5\r\n"), HasSubstr("\r\n\r\nup 1\n")));
  EXPECT_THAT(answer_to(port_, "GET /metrics?x=1 HTTP/1.0\n\n"), HasSubstr("\r\n\r\nup 1\n"));
  EXPECT_EQ(asked_, 2);
}

TEST_F(Http, OtherRequestsAreRefusedWithoutALookAtTheRig) {
  const auto refused = [&](std::string_view request, const char* status) {
    EXPECT_THAT(answer_to(port_, request), StartsWith(std::string("HTTP/1.1 ") + status));
  };
  refused("GET / HTTP/1.1\r\n\r\n", "404 Not Found");
  refused("POST /metrics HTTP/1.1\r\n\r\n", "405 Method Not Allowed");
  refused("nonsense\r\n\r\n", "400 Bad Request");
  refused("\r\n\r\n", "400 Bad Request");
  refused("GET  HTTP/1.1\r\n\r\n", "400 Bad Request");
  refused("GET /metrics SMTP\r\n\r\n", "400 Bad Request");
  refused(std::string(HttpServer::kLongestRequest + 1, 'x'), "431 ");
  EXPECT_EQ(asked_, 0);
  EXPECT_THAT(answer_to(port_, "HEAD /metrics HTTP/1.1\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), Not(HasSubstr("up 1"))));
}

TEST_F(Http, ARequestMayComeInPieces) {
  const auto client = connected(port_);
  for (const char byte : kScrape) say(client, {&byte, 1});
  EXPECT_THAT(heard(client), HasSubstr("\r\n\r\nup 1\n"));
}

TEST_F(Http, ALongTextArrivesCompletely) {
  body_ = std::string(20'000'000, 'x') + "end";
  EXPECT_THAT(answer_to(port_, kScrape).substr(20'000'000), testing::EndsWith("end"));
}

TEST_F(Http, ClientsThatSayNothingOrHalfARequestKeepNobodyWaiting) {
  std::vector<UniqueFd> silent;
  for (std::size_t i = 0; i < HttpServer::kMostConnections; ++i) {
    silent.push_back(connected(port_));
    if (i % 2 == 0) say(silent.back(), "GET /metr");
  }
  EXPECT_THAT(answer_to(port_, kScrape), HasSubstr("\r\n\r\nup 1\n"));
}

/// A client that has asked for more than the kernel keeps for it, and reads nothing.
UniqueFd slow_reader(int port, const std::atomic<int>& asked) {
  auto slow = connected(port);
  say(slow, kScrape);
  for (const auto limit = Deadline::in(std::chrono::seconds(20)); asked == 0 && !limit.passed();)
    sleep_until_ns(now_ns() + 1'000'000);
  return slow;
}

TEST_F(Http, AClientThatReadsNothingKeepsNobodyWaiting) {
  body_ = std::string(20'000'000, 'x');
  const auto slow = slow_reader(port_, asked_);
  ASSERT_EQ(asked_, 1);
  EXPECT_EQ(answer_to(port_, "GET / HTTP/1.1\r\n\r\n").substr(9, 3), "404");
}

TEST_F(HastyHttp, AClientThatReadsNothingLosesItsConnection) {
  body_ = std::string(20'000'000, 'x');
  const auto slow = slow_reader(port_, asked_);
  ASSERT_EQ(asked_, 1);
  sleep_until_ns(now_ns() + 2'000'000'000);
  const auto late = heard(slow);
  EXPECT_LT(late.size(), body_.size());
  EXPECT_THAT(late, Not(testing::EndsWith("hang")));
}

TEST_F(HastyHttp, AHalfOpenConnectionIsClosed) {
  const auto half = connected(port_);
  say(half, "GET /metr");
  EXPECT_EQ(heard(half), "");
}

TEST(HttpRequests, AreIncompleteUntilTheirEmptyLine) {
  EXPECT_FALSE(parse_http_request(""));
  EXPECT_FALSE(parse_http_request("GET /metrics HTTP/1.1\r\nHost: x\r\n"));
  EXPECT_TRUE(parse_http_request(kScrape));
}

}  // namespace
}  // namespace handcast::supervisor
