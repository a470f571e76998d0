// SPDX-License-Identifier: Apache-2.0
// The eye of scripts/night: prints a line for each frame of a rig's light, until the rig is down:
// when it was published (CLOCK_MONOTONIC, s) and its lit pixels, of which every seventh is looked
// at.
//   handcast_night_eye [RIG]
#include <cstdio>

#include "ipc/client/stream.hpp"
#include "ipc/msg/projection.hpp"

using namespace handcast;
using namespace std::chrono_literals;

namespace {

int lit_pixels(const msg::Projection& light) {
  constexpr std::uint32_t kColours = 0x00ffffff;  // RGBA8: the last byte, alpha, is the highest
  const auto count = std::size_t{light.region_width_px} * light.region_height_px;
  int lit = 0;
  for (std::size_t i = 0; i < count; i += 7) lit += (light.pixels()[i] & kColours) != 0;
  return lit;
}

}  // namespace

int main(int argc, char** argv) {
  auto frames = client::open_stream<msg::Projection>(argc > 1 ? argv[1] : "", "projection.frames");
  while (frames) {
    const auto frame = frames->next(Deadline::in(1s));
    if (!frame && frame.error().code != Errc::timeout) return 1;
    if (!frame) continue;
    std::printf("%.4f %d\n", ns_to_seconds((*frame)->header.published_ns), lit_pixels(**frame));
    std::fflush(stdout);
  }
  return 1;
}
