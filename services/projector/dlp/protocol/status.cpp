// SPDX-License-Identifier: Apache-2.0
// Source of the bits: TI DLPU010 and DLPU018, "Hardware Status", "System Status", "Main Status",
// and DLPU010, "Validate Data".
#include "services/projector/dlp/protocol/status.hpp"

#include <array>

namespace handcast::dlp::protocol {
namespace {

constexpr std::uint8_t bit(int number) { return static_cast<std::uint8_t>(1u << number); }

/// A bit of a status byte that means a fault.
struct Fault {
  std::uint8_t Status::*byte;
  int bit;
  bool when;          ///< the value that means the fault
  bool only_dlpc900;  ///< the DLPC350 does not define the bit
  std::string_view sentence;
};

constexpr std::array kFaults{
    Fault{&Status::hardware, 0, false, false,
          "its initialisation has failed; switch it off and on"},
    Fault{&Status::hardware, 1, true, true,
          "its firmware does not fit its mirrors; load the firmware of this projector"},
    Fault{&Status::hardware, 2, true, false,
          "mirrors were switched twice at once (DMD reset controller error)"},
    Fault{
        &Status::hardware, 3, true, false,
        "it has changed to a frame that was not complete (forced swap); does the video signal have "
        "the rate that projector.rate_hz says?"},
    Fault{&Status::hardware, 6, true, false, "its sequencer has given up the sequence"},
    Fault{&Status::hardware, 7, true, false, "its sequencer reports an error"},
    Fault{&Status::system, 0, false, false, "the test of its memory has failed"},
    Fault{&Status::main, 0, true, false, "its mirrors are parked, so there is no light"},
    Fault{&Status::main, 2, true, false, "its picture is frozen"},
};

}  // namespace

bool is_running(const Status& status) { return (status.main & bit(1)) != 0; }

std::vector<std::string_view> faults_of(Controller controller, const Status& status) {
  std::vector<std::string_view> sentences;
  for (const Fault& fault : kFaults) {
    if (fault.only_dlpc900 && controller != Controller::dlpc900) continue;
    if (((status.*fault.byte & bit(fault.bit)) != 0) == fault.when)
      sentences.push_back(fault.sentence);
  }
  return sentences;
}

Validation explain_validation(std::uint8_t bits) {
  Validation validation;
  if (bits & bit(0))
    validation.errors.push_back("the exposure or the period of a pattern is not possible");
  if (bits & bit(1)) validation.errors.push_back("the number of a pattern is not possible");
  if (bits & bit(2))
    validation.warnings.push_back("trigger output 1 stays active, or black patterns overlap");
  if (bits & bit(3))
    validation.warnings.push_back("there is no black pattern before one that waits for a trigger");
  if (bits & bit(4))
    validation.warnings.push_back("exposure and period differ by less than 230 µs");
  return validation;
}

}  // namespace handcast::dlp::protocol
