// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/http_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>

#include "ipc/base/clock.hpp"
#include "services/desk/base/low_priority.hpp"

namespace handcast::desk {
namespace {

/// If most connections are taken, those that have not asked for anything are ended so soon.
constexpr std::int64_t kCrowded_ns = 100'000'000;
/// The same with encryption, which takes several messages to and fro before anything is asked.
constexpr std::int64_t kCrowdedEncrypted_ns = 1'000'000'000;

constexpr const char* kTlsVersions = "SECURE128:-VERS-ALL:+VERS-TLS1.3:+VERS-TLS1.2";

/// One request while it comes in.
struct Incoming {
  HttpRequest request;
  bool is_refused = false;
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

MHD_Result take_header(void* headers, MHD_ValueKind, const char* name, const char* value) {
  auto& all = *static_cast<std::map<std::string, std::string>*>(headers);
  auto [at, is_new] = all.emplace(lower(name), value ? value : "");
  if (!is_new) at->second += std::string(", ") + (value ? value : "");
  return MHD_YES;
}

/// The end of a connection that is this computer's: "192.168.1.5:8481".
std::string local_of(MHD_Connection* connection) {
  const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  char text[INET_ADDRSTRLEN] = "?";
  if (!info || ::getsockname(info->connect_fd, reinterpret_cast<sockaddr*>(&own), &size) != 0)
    return text;
  inet_ntop(AF_INET, &own.sin_addr, text, sizeof text);
  return fmt::format("{}:{}", text, ntohs(own.sin_port));
}

std::string peer_of(MHD_Connection* connection) {
  const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
  char text[INET6_ADDRSTRLEN] = "?";
  if (info && info->client_addr && info->client_addr->sa_family == AF_INET)
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(info->client_addr)->sin_addr, text,
              sizeof text);
  else if (info && info->client_addr && info->client_addr->sa_family == AF_INET6)
    inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6*>(info->client_addr)->sin6_addr, text,
              sizeof text);
  return text;
}

/// The announced length of a body; empty if it is none, or is not a number.
bool is_too_long(const HttpRequest& request, std::size_t most) {
  const auto text = request.header("content-length");
  if (text.empty()) return false;
  std::uint64_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  return error != std::errc() || end != text.data() + text.size() || length > most;
}

/// A stream, and what of it did not fit into the last packet.
struct Flow {
  std::unique_ptr<ByteStream> stream;
  std::atomic<bool>* is_closing;
  std::string waiting;
  std::size_t sent = 0;
};

ssize_t read_flow(void* context, std::uint64_t, char* buffer, std::size_t most) {
  auto& flow = *static_cast<Flow*>(context);
  while (flow.sent == flow.waiting.size()) {
    flow.waiting.clear();
    flow.sent = 0;
    if (*flow.is_closing || !flow.stream->read(flow.waiting))
      return MHD_CONTENT_READER_END_OF_STREAM;
  }
  const auto count = std::min(most, flow.waiting.size() - flow.sent);
  std::copy_n(flow.waiting.data() + flow.sent, count, buffer);
  flow.sent += count;
  return static_cast<ssize_t>(count);
}

void end_flow(void* context) { delete static_cast<Flow*>(context); }

Result<sockaddr_in> socket_address(const std::string& address, std::uint16_t port) {
  sockaddr_in socket{};
  socket.sin_family = AF_INET;
  socket.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &socket.sin_addr) != 1)
    return fail(Errc::bad_config, fmt::format("'{}' is not an address like 127.0.0.1", address));
  return socket;
}

}  // namespace

/// Counts how often each client connects. One thread.
class Door {
 public:
  explicit Door(const HttpLimits& limits)
      : most_(limits.connections_at_once), hz_(limits.connections_hz) {}

  bool lets_in(const sockaddr* client, std::int64_t now_ns) {
    if (client->sa_family != AF_INET) return true;  // it listens at addresses of IPv4
    if (visitors_.size() > kMostVisitors) visitors_.clear();
    const auto address = reinterpret_cast<const sockaddr_in*>(client)->sin_addr.s_addr;
    auto& [left, at_ns] = visitors_.try_emplace(address, Visitor{most_, now_ns}).first->second;
    left = std::min(most_, left + hz_ * ns_to_seconds(now_ns - at_ns));
    at_ns = now_ns;
    if (left < 1) return false;
    left -= 1;
    return true;
  }

 private:
  static constexpr std::size_t kMostVisitors = 1024;
  struct Visitor {
    double left;
    std::int64_t at_ns;
  };
  double most_, hz_;
  std::unordered_map<in_addr_t, Visitor> visitors_;
};

struct HttpServer::Impl {
  struct Connection {
    int socket = -1;
    std::int64_t begun_ns = 0;
    std::int64_t until_ns = 0;  ///< it must have come further by then
    bool has_asked = false;     ///< its request has come whole
  };

  Handler handler;
  HttpLimits limits;
  TlsKeys tls;
  std::atomic<bool> is_closing = false;
  std::optional<Door> door;  ///< of the thread that accepts
  MHD_Daemon* daemon = nullptr;
  std::mutex mutex;
  std::condition_variable wake;
  std::unordered_map<MHD_Connection*, Connection> connections;
  std::thread reaper;

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      is_closing = true;
      for (const auto& [connection, state] : connections) ::shutdown(state.socket, SHUT_RDWR);
    }
    wake.notify_all();
    if (reaper.joinable()) reaper.join();
    if (daemon) MHD_stop_daemon(daemon);
  }

  /// Ends connections that have not come further in time. MHD itself only knows how long a
  /// connection was silent, and one byte a second is not silence.
  void reap() {
    run_at_low_priority();
    const auto crowded_ns = tls.certificate.empty() ? kCrowded_ns : kCrowdedEncrypted_ns;
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait(lock, [&] { return is_closing || !connections.empty(); });
      if (is_closing) return;
      wake.wait_for(lock, std::chrono::nanoseconds(kCrowded_ns));
      const auto now = now_ns();
      const bool is_crowded = connections.size() > limits.connections * 3 / 4;
      for (auto& [connection, state] : connections)
        if (now > state.until_ns ||
            (is_crowded && !state.has_asked && now > state.begun_ns + crowded_ns))
          ::shutdown(state.socket, SHUT_RDWR);
    }
  }

  /// The request of a connection has come whole.
  void set_deadline(MHD_Connection* connection, std::int64_t until_ns) {
    const std::lock_guard lock(mutex);
    const auto found = connections.find(connection);
    if (found == connections.end()) return;
    found->second.until_ns = until_ns;
    found->second.has_asked = true;
  }

  MHD_Result answer(MHD_Connection* connection, HttpAnswer answer) {
    const bool is_stream = answer.stream != nullptr;
    MHD_Response* response = nullptr;
    if (is_stream)
      response = MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, 16 << 10, read_flow,
                                                   new Flow{std::move(answer.stream), &is_closing},
                                                   end_flow);
    else
      response = MHD_create_response_from_buffer(answer.body.size(), answer.body.data(),
                                                 MHD_RESPMEM_MUST_COPY);
    if (!response) return MHD_NO;
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, answer.type.c_str());
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONNECTION, "close");
    for (const auto& [name, value] : answer.headers)
      MHD_add_response_header(response, name.c_str(), value.c_str());
    set_deadline(connection, is_stream ? INT64_MAX : now_ns() + limits.answer_ns);
    const auto queued =
        MHD_queue_response(connection, static_cast<unsigned>(answer.status), response);
    MHD_destroy_response(response);
    return queued;
  }

  MHD_Result begin(MHD_Connection* connection, const char* url, const char* method,
                   void** context) {
    auto incoming = std::make_unique<Incoming>();
    auto& request = incoming->request;
    request.method = method;
    request.path = url;
    request.peer = peer_of(connection);
    request.local = local_of(connection);
    request.is_encrypted = !tls.certificate.empty();
    MHD_get_connection_values(connection, MHD_HEADER_KIND, take_header, &request.headers);
    incoming->is_refused = is_too_long(request, limits.body_bytes);
    const bool is_refused = incoming->is_refused;
    *context = incoming.release();
    // Answered before the body has come, MHD closes the connection without reading it.
    if (!is_refused) return MHD_YES;
    return answer(connection, {.status = 413,
                               .type = "application/json",
                               .body = R"({"error":"The request is too large."})",
                               .headers = {},
                               .stream = nullptr});
  }

  MHD_Result take_body(Incoming& incoming, const char* bytes, std::size_t& size) const {
    if (incoming.request.body.size() + size > limits.body_bytes) return MHD_NO;
    incoming.request.body.append(bytes, size);
    size = 0;
    return MHD_YES;
  }

  /// Called with the header, then with each part of the body, and at last without one.
  static MHD_Result on_request(void* self, MHD_Connection* connection, const char* url,
                               const char* method, const char*, const char* bytes,
                               std::size_t* size, void** context) {
    auto& impl = *static_cast<Impl*>(self);
    if (!*context) return impl.begin(connection, url, method, context);
    auto& incoming = *static_cast<Incoming*>(*context);
    if (*size != 0) return impl.take_body(incoming, bytes, *size);
    impl.set_deadline(connection, INT64_MAX);  // the handler has limits of its own
    return impl.answer(connection, impl.handler(incoming.request));
  }

  static void on_completed(void*, MHD_Connection*, void** context, MHD_RequestTerminationCode) {
    delete static_cast<Incoming*>(*context);
    *context = nullptr;
  }

  static void on_connection(void* self, MHD_Connection* connection, void**,
                            MHD_ConnectionNotificationCode what) {
    auto& impl = *static_cast<Impl*>(self);
    const std::lock_guard lock(impl.mutex);
    if (what == MHD_CONNECTION_NOTIFY_CLOSED) {
      impl.connections.erase(connection);
      return;
    }
    const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    impl.connections[connection] = {info->connect_fd, now_ns(), now_ns() + impl.limits.request_ns,
                                    false};
    impl.wake.notify_all();
    if (impl.is_closing) ::shutdown(info->connect_fd, SHUT_RDWR);
  }

  static MHD_Result on_arrival(void* self, const sockaddr* client, socklen_t) {
    return static_cast<Impl*>(self)->door->lets_in(client, now_ns()) ? MHD_YES : MHD_NO;
  }

  void start(const sockaddr_in& address) {
    door.emplace(limits);
    const bool is_encrypted = !tls.certificate.empty();
    const std::array<MHD_OptionItem, 4> keys{
        {{MHD_OPTION_HTTPS_MEM_CERT, 0, tls.certificate.data()},
         {MHD_OPTION_HTTPS_MEM_KEY, 0, tls.key.data()},
         {MHD_OPTION_HTTPS_PRIORITIES, 0, const_cast<char*>(kTlsVersions)},
         {MHD_OPTION_END, 0, nullptr}}};
    daemon = MHD_start_daemon(
        MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_POLL |
            (is_encrypted ? MHD_USE_TLS : 0),
        0, on_arrival, this, on_request, this, MHD_OPTION_SOCK_ADDR, &address,
        MHD_OPTION_CONNECTION_LIMIT, limits.connections, MHD_OPTION_CONNECTION_TIMEOUT,
        limits.stall_s, MHD_OPTION_CONNECTION_MEMORY_LIMIT, limits.header_bytes,
        MHD_OPTION_THREAD_STACK_SIZE, std::size_t{256 << 10}, MHD_OPTION_NOTIFY_COMPLETED,
        on_completed, nullptr, MHD_OPTION_NOTIFY_CONNECTION, on_connection, this, MHD_OPTION_ARRAY,
        is_encrypted ? keys.data() : &keys.back(), MHD_OPTION_END);
  }
};

HttpServer::HttpServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HttpServer::~HttpServer() = default;

Result<std::unique_ptr<HttpServer>> HttpServer::open(const std::string& address, std::uint16_t port,
                                                     Handler handler, HttpLimits limits,
                                                     TlsKeys tls) {
  const auto socket = socket_address(address, port);
  if (!socket) return tl::make_unexpected(socket.error());
  auto impl = std::make_unique<Impl>();
  impl->handler = std::move(handler);
  impl->limits = limits;
  impl->tls = std::move(tls);
  // Threads begin with the priority of the one that starts them.
  std::thread([&] {
    run_at_low_priority();
    impl->start(*socket);
  }).join();
  if (!impl->daemon)
    return fail(Errc::unavailable, fmt::format("nothing can be served at {}:{}: the port is taken, "
                                               "or the address is none of this computer",
                                               address, port));
  impl->reaper = std::thread([raw = impl.get()] { raw->reap(); });
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(impl)));
}

std::uint16_t HttpServer::port() const {
  const auto* info = MHD_get_daemon_info(impl_->daemon, MHD_DAEMON_INFO_BIND_PORT);
  return info ? info->port : 0;
}

}  // namespace handcast::desk
