// SPDX-License-Identifier: Apache-2.0
// A daemon that only publishes, to measure restarts without the work of a real service. Linked as
// handcast-camera, -pose, …, it publishes the stream of that service immediately and then at 500
// Hz. In its messages, frame_id is the pid and origin_ns the start of main().
#include <unistd.h>

#include <string>
#include <string_view>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "services/runtime/context.hpp"

namespace {

using namespace handcast;

constexpr std::int64_t kPeriod_ns = 2'000'000;

template <class Message>
void publish_one(ipc::Writer<Message>& writer, std::int64_t began_ns) {
  auto message = writer.loan();
  if (!message) return;
  message->header = {static_cast<std::uint64_t>(::getpid()), began_ns, 0};
  writer.publish(std::move(message));
}

template <class Message>
void run(service::Context& context, const std::string& stream, std::int64_t began_ns) {
  context.stand_by();
  auto writer = service::must(context.writer<Message>(stream));
  publish_one(writer, began_ns);
  context.ready();
  for (auto due_ns = now_ns() + kPeriod_ns; context.running(); due_ns += kPeriod_ns) {
    sleep_until_ns(due_ns);
    publish_one(writer, began_ns);
  }
}

struct Role {
  std::string service, stream;
  void (*run)(service::Context& context, const std::string& stream, std::int64_t began_ns);
};

const Role kRoles[] = {
    {"camera", "camera.frames", run<msg::CameraFrame>},
    {"pose", "pose.hands", run<msg::HandPoses>},
    {"landmarks", "landmarks.hands", run<msg::Landmarks>},
    {"projector", "projection.frames", run<msg::Projection>},
    {"content", "content.left", run<msg::ContentPicture>},
};

/// The role of handcast-NAME; the camera's for any other name.
const Role& role_of(std::string_view program) {
  for (const auto& role : kRoles)
    if (program.ends_with("-" + role.service)) return role;
  return kRoles[0];
}

}  // namespace

int main(int argc, char** argv) {
  const auto began_ns = now_ns();
  const Role& role = role_of(argv[0]);
  return service::run({.name = role.service,
                       .summary = "Publishes and does nothing else.",
                       .publishes = {role.stream}},
                      argc, argv,
                      [&](service::Context& context) { role.run(context, role.stream, began_ns); });
}
