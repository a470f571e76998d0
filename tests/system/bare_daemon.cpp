// SPDX-License-Identifier: Apache-2.0
// A daemon that only publishes, to measure restarts without the work of a real service. Linked as
// handcast-camera, -pose, …, it publishes the stream of that service immediately and then at 500
// Hz. In its messages, frame_id is the pid and origin_ns the start of main().
#include <unistd.h>

#include <cstring>
#include <string>

#include "ipc/msg/camera_frame.hpp"
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
void run(service::Context& context, const char* stream, std::int64_t began_ns) {
  context.stand_by({stream});
  auto writer = service::must(context.writer<Message>(stream));
  publish_one(writer, began_ns);
  context.ready();
  for (auto due_ns = now_ns() + kPeriod_ns; context.running(); due_ns += kPeriod_ns) {
    sleep_until_ns(due_ns);
    publish_one(writer, began_ns);
  }
}

void run_as(const std::string& name, service::Context& context, std::int64_t began_ns) {
  if (name == "camera") run<msg::CameraFrame>(context, "camera.frames", began_ns);
  if (name == "pose") run<msg::HandPoses>(context, "pose.hands", began_ns);
  if (name == "landmarks") run<msg::Landmarks>(context, "landmarks.hands", began_ns);
  if (name == "projector") run<msg::Projection>(context, "projection.frames", began_ns);
}

}  // namespace

int main(int argc, char** argv) {
  const auto began_ns = now_ns();
  const char* dash = std::strrchr(argv[0], '-');
  const std::string name = dash ? dash + 1 : "camera";
  return service::run({name, "Publishes and does nothing else.", {}}, argc, argv,
                      [&](service::Context& context) { run_as(name, context, began_ns); });
}
