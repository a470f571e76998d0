// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::daemon {

/// What a daemon has written to its ready descriptor since the supervisor last read it.
struct Words {
  bool any = false;     ///< it wrote something: a sign of life
  bool ready = false;   ///< it is ready
  bool closed = false;  ///< it will write no more
};

/// Reads the supervisor's end of a ready descriptor. Waits only if the descriptor is a blocking
/// one.
Words read_words(int ready_fd);

/// Gives a standby its turn, through the supervisor's end of its standby descriptor. False if it
/// cannot be reached.
bool give_turn(int standby_fd);

}  // namespace handcast::daemon
