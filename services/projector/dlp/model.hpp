// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "services/projector/dlp/link.hpp"
#include "services/projector/dlp/protocol/status.hpp"
#include "services/projector/dlp/sequence/encode.hpp"

namespace handcast::dlp {

/// What differs between the controllers. One thread.
class Model {
 public:
  virtual ~Model() = default;

  /// Whether a video signal is there and understood.
  virtual Result<bool> has_signal(Link& link, const protocol::Status& status,
                                  Deadline deadline) = 0;
  /// Shows the video as an ordinary picture.
  virtual Result<void> show_video(Link& link, Deadline deadline) = 0;
  /// Prepares a sequence that stands still. Returns what it waits for; "" if it can be started.
  /// Warnings are appended to `events`. Errors: see Link; bad_config (the controller cannot show
  /// the sequence).
  virtual Result<std::string> prepare(Link& link, const Sequence& sequence,
                                      const Triggers& triggers, std::vector<std::string>& events,
                                      Deadline deadline) = 0;
};

std::unique_ptr<Model> make_dlpc350();
std::unique_ptr<Model> make_dlpc900();

}  // namespace handcast::dlp
