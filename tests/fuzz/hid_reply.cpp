// SPDX-License-Identifier: Apache-2.0
// What a DLP controller sends: reports of any length, one after the other.

#include "services/projector/dlp/protocol/payload.hpp"
#include "services/projector/dlp/protocol/status.hpp"
#include "tests/fuzz/input.hpp"

using namespace handcast;
using namespace handcast::dlp::protocol;

static void use(const Bytes& data) {
  fuzz::require(data.size() <= kMostReplyBytes);
  if (const auto version = decode_version(data)) fuzz::require(!version->empty());
  if (data.size() < 3) return;
  fuzz::require(!explain_error_code(data[0]).empty());
  const Status status{.hardware = data[0], .system = data[1], .main = data[2]};
  for (const auto controller : {Controller::dlpc350, Controller::dlpc900})
    for (const auto fault : faults_of(controller, status)) fuzz::require(!fault.empty());
  const auto validation = explain_validation(data[0]);
  fuzz::require(validation.errors.size() + validation.warnings.size() <= 5);
}

/// The first byte is the sequence number of the message; then each report, with its length before
/// it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  fuzz::Reader input({bytes, count});
  ReplyReader reader(input.number<std::uint8_t>());
  while (!input.at_end()) {
    const auto length = input.number<std::uint8_t>() % (kReportBytes + 1);
    const auto reply = reader.take(input.take(length));
    if (!reply) {
      fuzz::require(reply.error().code == Errc::bad_data && !reply.error().what.empty());
      break;
    }
    if (*reply) {
      use((*reply)->data);
      break;  // the host asks the next question
    }
  }
  return 0;
}
