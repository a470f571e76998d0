// SPDX-License-Identifier: Apache-2.0
// Instead of rtmidi_port.cpp in a build without the library.
#include "services/desk/midi/port/port.hpp"

namespace handcast::desk::midi {

Result<std::unique_ptr<Port>> open_port(std::string_view) {
  return fail(Errc::bad_config, "this build has no MIDI; install librtmidi-dev and build again");
}

}  // namespace handcast::desk::midi
