// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/control_client.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "ipc/control/rig_address.hpp"

namespace handcast::control {
namespace {

constexpr std::size_t kLongestAnswer = 1 << 24;

/// What has been received so far.
struct Received {
  std::string line;
  std::vector<UniqueFd> descriptors;
};

/// Restarts and stops take as long as the services do.
bool may_take_long(Verb verb) {
  return verb == Verb::down || verb == Verb::restart || verb == Verb::swap || verb == Verb::reload;
}

/// Waits until the socket is readable. Errors: timeout.
Result<void> wait_for(int socket, Deadline deadline) {
  for (;;) {
    const auto left_ns = deadline.time_ns() - now_ns();
    pollfd readable{.fd = socket, .events = POLLIN, .revents = 0};
    if (poll(&readable, 1, static_cast<int>(std::max<std::int64_t>(left_ns / 1'000'000, 0))) > 0)
      return {};
    if (deadline.passed()) return fail(Errc::timeout, "no answer in time");
  }
}

void take_descriptors(msghdr& message, std::vector<UniqueFd>& descriptors) {
  for (auto* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const auto count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(part) + i * sizeof fd, sizeof fd);
      descriptors.emplace_back(fd);
    }
  }
}

/// Receives what can be received without waiting. Errors: unavailable (the rig went away, or this
/// program cannot have as many descriptors), bad_data.
Result<void> receive(int socket, Received& received) {
  std::array<char, 1 << 16> bytes;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(kMostDescriptors * sizeof(int))> room;
  iovec text{.iov_base = bytes.data(), .iov_len = bytes.size()};
  msghdr message{};
  message.msg_iov = &text;
  message.msg_iovlen = 1;
  message.msg_control = room.data();
  message.msg_controllen = room.size();
  const auto count = recvmsg(socket, &message, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (count <= 0) return fail(Errc::unavailable, "the rig went away before it answered");
  take_descriptors(message, received.descriptors);
  if (message.msg_flags & MSG_CTRUNC)
    return fail(Errc::unavailable,
                "this program cannot hold that many descriptors; see `ulimit -n`");
  received.line.append(bytes.data(), static_cast<std::size_t>(count));
  if (received.line.size() > kLongestAnswer)
    return fail(Errc::bad_data, "the rig's answer does not end");
  return {};
}

/// Receives until the line is complete. Errors: as receive(); timeout.
Result<void> receive_line(int socket, Received& received, Deadline deadline) {
  while (!received.line.ends_with('\n')) {
    if (auto readable = wait_for(socket, deadline); !readable) return readable;
    if (auto taken = receive(socket, received); !taken) return taken;
  }
  return {};
}

Result<UniqueFd> send_to(const std::string& rig, const Request& request) {
  const auto address = address_of(rig);
  if (!address) return tl::make_unexpected(address.error());
  auto socket = connect_to(*address);
  if (!socket) return tl::make_unexpected(socket.error());
  const auto line = print_request(request) + "\n";
  if (::send(socket->get(), line.data(), line.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(line.size()))
    return fail(Errc::unavailable, fmt::format("rig '{}' does not take requests", rig));
  return socket;
}

/// Whether the supervisor answers another request in time.
bool is_awake(const std::string& rig, std::chrono::nanoseconds patience) {
  const auto socket = send_to(rig, {});
  Received received;
  return socket && receive_line(socket->get(), received, Deadline::in(patience));
}

/// How many descriptors belong to this answer.
std::size_t expected_descriptors(Verb verb, const nlohmann::json& answer) {
  if (verb == Verb::history) return 1;
  return verb == Verb::rings && answer.contains("rings") ? answer["rings"].size() : 0;
}

Result<Answer> read_answer(const std::string& rig, Verb verb, Received received) {
  auto object = nlohmann::json::parse(received.line, nullptr, false);
  if (!object.is_object())
    return fail(Errc::bad_data, fmt::format("rig '{}' gave an answer that makes no sense", rig));
  if (object["ok"] != true)
    return fail(Errc::bad_data, object["error"].is_string() ? object["error"].get<std::string>()
                                                            : "the rig refused without a reason");
  const auto expected = expected_descriptors(verb, object);
  if (received.descriptors.size() < expected)
    return fail(Errc::bad_data, fmt::format("rig '{}' sent {} descriptors of {}", rig,
                                            received.descriptors.size(), expected));
  while (received.descriptors.size() > expected) received.descriptors.pop_back();
  return Answer{std::move(object), std::move(received.descriptors)};
}

}  // namespace

Result<nlohmann::json> ask(const std::string& rig, const Request& request) {
  auto answer = ask_with_descriptors(rig, request);
  if (!answer) return tl::make_unexpected(answer.error());
  return std::move(answer->object);
}

Result<Answer> ask_with_descriptors(const std::string& rig, const Request& request,
                                    std::chrono::nanoseconds patience) {
  const auto socket = send_to(rig, request);
  if (!socket) return tl::make_unexpected(socket.error());
  Received received;
  for (;;) {
    const auto whole = receive_line(socket->get(), received, Deadline::in(patience));
    if (whole) return read_answer(rig, request.verb, std::move(received));
    if (whole.error().code != Errc::timeout) return tl::make_unexpected(whole.error());
    if (!may_take_long(request.verb) || !is_awake(rig, patience))
      return fail(Errc::unavailable,
                  fmt::format("rig '{}' has not answered for {:g} s: its supervisor hangs", rig,
                              ns_to_seconds(patience.count())));
  }
}

Result<std::string> ask_for_rig(const std::string& rig) {
  const auto answer = ask_with_descriptors(rig, {.verb = Verb::rig}, std::chrono::seconds(2));
  if (!answer) return tl::make_unexpected(answer.error());
  const auto text = answer->object.find("rig");
  if (text == answer->object.end() || !text->is_string())
    return fail(Errc::bad_data, "the supervisor does not say the settings of the rig");
  return text->get<std::string>();
}

}  // namespace handcast::control
