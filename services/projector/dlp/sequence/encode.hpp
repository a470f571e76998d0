// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/projector/dlp/protocol/message.hpp"
#include "services/projector/dlp/sequence/sequence.hpp"

namespace handcast::dlp {

/// A command that sets something.
struct Setting {
  protocol::Command command;
  protocol::Bytes data;
};

/// [dlp] trigger_in, trigger_out.
struct Triggers {
  bool in = false, out = false;
};

/// The commands that prepare a sequence, in their order, for a controller in its pattern mode whose
/// sequence stands still. The DLPC350 must then validate it.
/// @{
std::vector<Setting> encode_for_dlpc350(const Sequence& sequence, const Triggers& triggers);
std::vector<Setting> encode_for_dlpc900(const Sequence& sequence, const Triggers& triggers);
/// @}

}  // namespace handcast::dlp
