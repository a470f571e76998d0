// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/control/control_message.hpp"
#include "supervisor/base/event_loop.hpp"

namespace handcast::supervisor {

/// The rig's end of the control socket, on the event loop. Whoever has the socket has the name of
/// the rig; the kernel frees it with the process. The server never blocks: answers that a client
/// has not read yet are kept up to a limit, and a client beyond the limit is dropped.
class ControlServer {
 public:
  /// Answers a request, now or later. Does nothing if the client has left. Must not be called after
  /// the server's end.
  class Reply {
   public:
    /// The client gets duplicates of `descriptors`.
    void operator()(const nlohmann::json& answer, const std::vector<int>& descriptors = {}) const {
      send_(answer, descriptors);
    }
    /// Sends an answer with descriptors to the client, if it is still there.
    using Send = std::function<void(const nlohmann::json&, const std::vector<int>&)>;
    Reply() = default;
    /// Stores the function that sends.
    explicit Reply(Send send) : send_(std::move(send)) {}

   private:
    Send send_;
  };
  /// Carries out a request; called on the event loop.
  using OnRequest = std::function<void(const control::Request&, Reply)>;

  /// Claims the name of `rig` and accepts connections. Errors: unavailable (a rig of this name is
  /// up), bad_config (the name; another user has it).
  static Result<std::unique_ptr<ControlServer>> listen(const std::string& rig, EventLoop& loop,
                                                       OnRequest on_request);
  ~ControlServer();
  /// Stops accepting and frees the name. Pending requests are still answered.
  void stop_accepting();

 private:
  struct Client {
    UniqueFd socket;
    std::string unread;  ///< of its next request
    std::string unsent;  ///< of its answers: what did not fit into the socket's buffer
    int unanswered = 0;  ///< requests without an answer
    bool is_idle() const { return unanswered == 0 && unsent.empty(); }
  };
  ControlServer(UniqueFd listener, EventLoop& loop, OnRequest on_request);

  void accept();
  void make_room();
  void read(std::uint64_t id);
  void answer_line(std::uint64_t id, const std::string& line);
  void send(std::uint64_t id, const nlohmann::json& answer,
            const std::vector<int>& descriptors = {});
  static bool send_some(Client& client, const std::vector<int>& descriptors);
  void send_rest(std::uint64_t id);
  void drop(std::uint64_t id);

  UniqueFd listener_;
  EventLoop& loop_;
  OnRequest on_request_;
  std::uint64_t next_id_ = 0;
  std::map<std::uint64_t, Client> clients_;  ///< oldest first
};

}  // namespace handcast::supervisor
