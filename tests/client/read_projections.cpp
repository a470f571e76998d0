// SPDX-License-Identifier: Apache-2.0
// Prints a line for each frame that a rig projects, until the rig is down: its number, the time the
// light is for (CLOCK_MONOTONIC), and how old its inputs are by then.
//   read_projections [RIG]
#include <cstdio>
#include <utility>

#include "ipc/client/stream.hpp"
#include "ipc/msg/projection.hpp"

using namespace handcast;
using namespace std::chrono_literals;

static int complain(const Error& error) {
  std::fprintf(stderr, "read_projections: %s\n", error.what.c_str());
  return 1;
}

static void print(const msg::Projection& light) {
  std::printf("frame %llu for %.3f ms:", static_cast<unsigned long long>(light.header.frame_id),
              ns_to_ms(light.target_ns));
  const auto& from = light.made_from;
  for (const auto& [input, time_ns] : {std::pair{"image", from.image_ns},
                                       {"pose", from.pose_ns},
                                       {"landmarks", from.landmarks_ns}})
    if (time_ns != 0) std::printf(" %s %.2f ms", input, ns_to_ms(light.target_ns - time_ns));
  std::printf(" old\n");
  std::fflush(stdout);
}

int main(int argc, char** argv) {
  auto frames = client::open_stream<msg::Projection>(argc > 1 ? argv[1] : "", "projection.frames");
  if (!frames) return complain(frames.error());
  for (;;) {
    const auto frame = frames->next(Deadline::in(1s));
    if (frame)
      print(**frame);
    else if (frame.error().code != Errc::timeout)  // after a timeout the rig is up, and dark
      return complain(frame.error());
  }
}
