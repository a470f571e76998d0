#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "supervisor/control_message.hpp"
#include "supervisor/event_loop.hpp"

namespace handcast::supervisor {

/// The rig's end of the control socket, on the event loop. The socket file goes with the object.
class ControlServer {
 public:
  /// Answers the request, now or later; does nothing if the client has left. Must not outlive the server.
  using Reply = std::function<void(const nlohmann::json&)>;
  using OnRequest = std::function<void(const Request&, Reply)>;

  /// Errors: unavailable (a rig of this name is up), bad_config (its name, the folder).
  static Result<std::unique_ptr<ControlServer>> listen(const std::string& rig, EventLoop& loop, OnRequest on_request);
  ~ControlServer();
  /// Lets nobody in any more and gives the name free. Those inside still get their answers.
  void close_door();

 private:
  struct Client {
    UniqueFd socket;
    std::string unread;
  };
  ControlServer(UniqueFd listener, std::filesystem::path path, EventLoop& loop, OnRequest on_request);

  void accept();
  void read(std::uint64_t id);
  void answer_line(std::uint64_t id, const std::string& line);
  void send(std::uint64_t id, const nlohmann::json& answer);
  void drop(std::uint64_t id);

  UniqueFd listener_;
  std::filesystem::path path_;
  EventLoop& loop_;
  OnRequest on_request_;
  std::uint64_t next_id_ = 0;
  std::map<std::uint64_t, Client> clients_;
};

}  // namespace handcast::supervisor
