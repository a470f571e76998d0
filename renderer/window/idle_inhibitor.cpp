// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/idle_inhibitor.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// For each answer of the bus and of the desktop.
constexpr auto kPatience = std::chrono::milliseconds(1000);
constexpr std::size_t kLongestMessage = 1 << 16;

/// A message in the wire format, little endian (specification, "Message Protocol").
class Message {
 public:
  void put_byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
  void put_number(std::uint32_t value) {
    align(4);
    for (int i = 0; i < 4; ++i) put_byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void put_string(std::string_view text) {
    put_number(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text).push_back('\0');
  }
  void put_signature(std::string_view text) {
    put_byte(static_cast<std::uint8_t>(text.size()));
    bytes_.append(text).push_back('\0');
  }
  /// A field of the header: its code, and its value of this type.
  void put_field(std::uint8_t code, char type, std::string_view value) {
    align(8);
    put_byte(code);
    put_signature(std::string(1, type));
    type == 'g' ? put_signature(value) : put_string(value);
  }
  void align(std::size_t to) { bytes_.resize((bytes_.size() + to - 1) / to * to, '\0'); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct Call {
  std::string_view name, path, interface, method;  ///< name: of the service
};

constexpr std::uint8_t kCall = 1, kReturn = 2;

std::string call_of(const Call& call, std::uint32_t serial, std::string_view signature,
                    const Message& body) {
  Message fields;
  fields.put_field(1, 'o', call.path);
  fields.put_field(2, 's', call.interface);
  fields.put_field(3, 's', call.method);
  fields.put_field(6, 's', call.name);
  if (!signature.empty()) fields.put_field(8, 'g', signature);
  Message message;
  for (const std::uint8_t byte : {std::uint8_t{'l'}, kCall, std::uint8_t{0}, std::uint8_t{1}})
    message.put_byte(byte);
  message.put_number(static_cast<std::uint32_t>(body.bytes().size()));
  message.put_number(serial);
  message.put_number(static_cast<std::uint32_t>(fields.bytes().size()));
  Message aligned;
  for (const char byte : message.bytes() + fields.bytes())
    aligned.put_byte(static_cast<std::uint8_t>(byte));
  aligned.align(8);
  return aligned.bytes() + body.bytes();
}

bool send_all(int socket, std::string_view bytes) {
  return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

/// Receives at least this many bytes, those in `received` included.
bool receive(int socket, std::size_t count, std::string& received) {
  for (const auto limit = Deadline::in(kPatience); received.size() < count;) {
    const auto left_ms = (limit.time_ns() - now_ns()) / 1'000'000;
    pollfd readable{.fd = socket, .events = POLLIN, .revents = 0};
    if (left_ms < 0 || ::poll(&readable, 1, static_cast<int>(left_ms)) <= 0) return false;
    std::array<char, 4096> bytes;
    const auto got = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got <= 0) return false;
    received.append(bytes.data(), static_cast<std::size_t>(got));
  }
  return true;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// Reads messages until one returns or fails a call. Returns its type; 0 if none comes.
std::uint8_t next_reply(int socket, std::string& received) {
  constexpr std::size_t kHeader = 16;
  constexpr std::uint8_t kSignal = 4;
  for (;;) {
    if (!receive(socket, kHeader, received)) return 0;
    const std::size_t fields = (std::size_t{number_at(received, 12)} + 7) / 8 * 8;
    const auto size = kHeader + fields + number_at(received, 4);
    if (received[0] != 'l' || size > kLongestMessage || !receive(socket, size, received)) return 0;
    const auto type = static_cast<std::uint8_t>(received[1]);
    received.erase(0, size);
    if (type != kCall && type != kSignal) return type;
  }
}

/// The value of a key in an address of a bus: "unix:path=/run/user/1000/bus,guid=...".
std::optional<std::string> value_in(std::string_view address, std::string_view key) {
  const auto at = address.find(key);
  if (!address.starts_with("unix:") || at == std::string_view::npos) return std::nullopt;
  const auto value = address.substr(at + key.size());
  return std::string(value.substr(0, value.find_first_of(",;")));
}

UniqueFd connect_to_session_bus() {
  const char* given = std::getenv("DBUS_SESSION_BUS_ADDRESS");
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  const auto address =
      given ? std::string(given) : fmt::format("unix:path={}/bus", folder ? folder : "");
  auto name = value_in(address, "path=");
  if (!name)
    if (const auto abstract = value_in(address, "abstract=")) name = '\0' + *abstract;
  sockaddr_un where{};
  if (!name || name->size() >= sizeof where.sun_path) return {};
  where.sun_family = AF_UNIX;
  std::memcpy(where.sun_path, name->data(), name->size());
  const auto size = offsetof(sockaddr_un, sun_path) + name->size() + ((*name)[0] == '\0' ? 0 : 1);
  UniqueFd bus(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!bus || ::connect(bus.get(), reinterpret_cast<const sockaddr*>(&where),
                        static_cast<socklen_t>(size)) != 0)
    return {};
  return bus;
}

/// Says who this is (specification, "Authentication Protocol").
bool introduce(int bus) {
  std::string user, answer;
  for (const char digit : fmt::to_string(getuid())) user += fmt::format("{:02x}", digit);
  if (!send_all(bus, std::string(1, '\0') + "AUTH EXTERNAL " + user + "\r\n")) return false;
  while (!answer.ends_with("\r\n"))
    if (!receive(bus, answer.size() + 1, answer)) return false;
  return answer.starts_with("OK ") && send_all(bus, "BEGIN\r\n");
}

}  // namespace

Result<IdleInhibitor> IdleInhibitor::open(const std::string& reason) {
  auto bus = connect_to_session_bus();
  if (!bus || !introduce(bus.get()))
    return fail(Errc::unavailable, "there is no session bus of a desktop");
  Message who;
  who.put_string("handcast");
  who.put_string(reason);
  constexpr std::string_view kBus = "org.freedesktop.DBus", kSaver = "org.freedesktop.ScreenSaver";
  const auto hello = call_of({kBus, "/org/freedesktop/DBus", kBus, "Hello"}, 1, "", {});
  const auto inhibit =
      call_of({kSaver, "/org/freedesktop/ScreenSaver", kSaver, "Inhibit"}, 2, "ss", who);
  std::string received;
  if (!send_all(bus.get(), hello) || next_reply(bus.get(), received) != kReturn ||
      !send_all(bus.get(), inhibit) || next_reply(bus.get(), received) != kReturn)
    return fail(Errc::unavailable, "no desktop answers on the session bus");
  return IdleInhibitor(std::move(bus));
}

}  // namespace handcast::renderer
