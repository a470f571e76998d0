// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/control/control_message.hpp"

namespace handcast::supervisor {

/// The rig's end of the control socket, on the event loop. The socket file goes with the object. It
/// waits for nobody: what a client has not read yet is kept for it up to a limit; a client that
/// lets more pile up is dropped.
class ControlServer {
 public:
  /// Answers the request, now or later; does nothing if the client has left. Must not outlive the
  /// server.
  class Reply {
   public:
    /// `descriptors` stay the caller's; the client gets its own of them.
    void operator()(const nlohmann::json& answer, const std::vector<int>& descriptors = {}) const {
      send_(answer, descriptors);
    }
    using Send = std::function<void(const nlohmann::json&, const std::vector<int>&)>;
    Reply() = default;
    explicit Reply(Send send) : send_(std::move(send)) {}

   private:
    Send send_;
  };
  using OnRequest = std::function<void(const Request&, Reply)>;

  /// Errors: unavailable (a rig of this name is up), bad_config (its name, the folder).
  static Result<std::unique_ptr<ControlServer>> listen(const std::string& rig, EventLoop& loop,
                                                       OnRequest on_request);
  ~ControlServer();
  /// Lets nobody in any more and gives the name free. Those inside still get their answers.
  void close_door();

 private:
  struct Client {
    UniqueFd socket;
    std::string unread;  ///< of its next request
    std::string unsent;  ///< of its answers: what did not fit into the socket's buffer
  };
  ControlServer(UniqueFd listener, std::filesystem::path path, EventLoop& loop,
                OnRequest on_request);

  void accept();
  void read(std::uint64_t id);
  void answer_line(std::uint64_t id, const std::string& line);
  void send(std::uint64_t id, const nlohmann::json& answer,
            const std::vector<int>& descriptors = {});
  static bool send_some(Client& client, const std::vector<int>& descriptors);
  void send_rest(std::uint64_t id);
  void drop(std::uint64_t id);

  UniqueFd listener_;
  std::filesystem::path path_;
  EventLoop& loop_;
  OnRequest on_request_;
  std::uint64_t next_id_ = 0;
  std::map<std::uint64_t, Client> clients_;
};

}  // namespace handcast::supervisor
