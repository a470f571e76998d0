// SPDX-License-Identifier: Apache-2.0
// What a Leap Motion Controller sends: its descriptors, then payloads, each with its length before
// it. Limits: 10 s and 1 GB per input.
#include <memory>
#include <vector>

#include "services/camera/leap/descriptors.hpp"
#include "services/camera/leap/receiver.hpp"
#include "services/camera/leap/transfer.hpp"
#include "tests/fuzz/input.hpp"

using namespace handcast;
using namespace handcast::camera::leap;

static void read_descriptors(fuzz::Reader& input) {
  const auto control = input.take(input.number<std::uint8_t>());
  const auto streaming = input.take(input.number<std::uint8_t>());
  const auto description = parse_descriptors(control, streaming);
  if (!description) return fuzz::require(!description.error().what.empty());
  for (const auto& mode : description->modes) {
    fuzz::require(mode.width_px > 0 && mode.height_px > 0 && mode.rate_hz >= 1);
    fuzz::require(mode_of(*description, mode.width_px, mode.height_px, mode.rate_hz).has_value());
    (void)transfers_of({}, 2, mode);
    (void)payload_bytes_of(streaming, mode);
  }
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input({data, size});
  read_descriptors(input);
  StreamFacts facts;
  facts.frame_bytes = 2 * (1 + input.number<std::uint8_t>());
  facts.payload_bytes = 64;
  facts.period_ns = 8'695'600;
  facts.clock_hz = input.number<std::uint8_t>() % 2 == 0 ? 1000 : input.number<std::uint32_t>();
  const auto mailbox = std::make_shared<Mailbox>(0);
  Receiver receiver(facts, mailbox);
  StereoImage image;
  std::int64_t time_ns = 1'000'000'000, last_ns = 0;
  std::uint64_t last = 0;
  bool has_come = false;
  while (!input.at_end()) {
    const auto length = input.number<std::uint8_t>();
    time_ns += 1000 * input.number<std::uint16_t>();
    const auto part = input.take(length);
    // In memory of its own, so that a byte too many is found.
    const std::vector<std::uint8_t> bytes(part.begin(), part.end());
    if (length == 0)
      receiver.on_lost_payload();
    else
      receiver.on_payload(bytes, time_ns);
    if (!mailbox->take(image, Deadline::now())) continue;
    fuzz::require(image.bytes.size() == facts.frame_bytes);
    fuzz::require(!has_come || (image.number > last && image.exposed_ns > last_ns));
    // Between two images, as many are counted as numbers are missing.
    const auto& lost = image.lost;
    fuzz::require(!has_come || lost.missing + lost.incomplete + lost.skipped ==
                                   static_cast<std::uint32_t>(image.number - last - 1));
    has_come = true;
    last = image.number;
    last_ns = image.exposed_ns;
  }
  return 0;
}
