// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [bridge]
struct Bridge {
  std::vector<std::string> send, receive;
  std::string from;
  bool ros = false;
  int domain = 0;
  std::string interface = "lo";
  std::vector<std::string> peers;
  double oldest_ms = 100;
  Process process{.wait = ipc::Wait::futex};

  /// Whether a rig has the service.
  bool is_wanted() const { return ros || !send.empty() || !receive.empty(); }
};

template <class Visitor>
void describe(Visitor& visitor, Bridge& bridge) {
  visitor.field("send", bridge.send,
                "The streams that other computers get: [\"pose.hands\", \"landmarks.hands\", "
                "\"live.settings\"]. Empty: none.");
  visitor.field("receive", bridge.receive,
                "The streams that come from another computer: \"pose.hands\" for pose.backend = "
                "\"external\", \"landmarks.hands\" for landmarks.backend = \"external\"; "
                "\"live.settings\": what people change of [light] and [content] there is "
                "changed here, too.");
  visitor.field("from", bridge.from,
                "Whose streams are received: \"RIG@COMPUTER\". Empty: those of the first that "
                "sends, until it stops.");
  visitor.field("ros", bridge.ros,
                "Send the joints also as ROS 2's geometry_msgs/PoseArray, in the topics "
                "/handcast/left/joints and /handcast/right/joints, and as frames of tf2.");
  visitor.field("domain", bridge.domain, between(0, 230),
                "The domain of DDS, the same on all computers (ROS_DOMAIN_ID).");
  visitor.field("interface", bridge.interface,
                "The network interface, e.g. \"eth0\". \"lo\": this computer only. Everybody on "
                "its network can read what is sent, and send: use a network of its own.");
  visitor.field("peers", bridge.peers,
                "Names or addresses of the other computers. Empty: they are found by multicast.");
  visitor.field("oldest_ms", bridge.oldest_ms, between(1, 1000, "ms"),
                "Messages that are older, or may be because the other computer's clock is not "
                "known well enough, are not used.");
  visitor.section("process", bridge.process, "The process of the service.");
}

}  // namespace handcast::config
