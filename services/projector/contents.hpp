// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "ipc/base/result.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/reader.hpp"
#include "renderer/base/mip_chain.hpp"

namespace handcast::projector {

/// What is painted on the hands: the newest picture of each, read where the content service has
/// written it. If no more comes, the last one stays. One thread.
class Contents {
 public:
  /// Takes the readers of content.left and content.right.
  Contents(ipc::Reader<msg::ContentPicture> left, ipc::Reader<msg::ContentPicture> right)
      : readers_{std::move(left), std::move(right)} {}

  /// Passes each picture that is new to pipeline.wear() (renderer::Pipeline, or a type with the
  /// same wear()), for as long as it is the newest. Does not wait. Errors: bad_data (a picture is
  /// unusable; the one before stays), unavailable.
  template <class Pipeline>
  Result<void> deliver(Pipeline& pipeline) {
    Result<void> all;
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const auto i = static_cast<std::size_t>(side);
      if (!readers_[i].await(Deadline::now())) continue;
      auto newest = readers_[i].latest(Deadline::now());
      if (!newest) {
        if (newest.error().code != Errc::timeout) all = tl::make_unexpected(newest.error());
        continue;
      }
      const msg::ContentPicture& picture = **newest;
      pipeline.wear(side, renderer::MipView{picture.mip_layout(), picture.texels()});
      shown_[i] = std::move(*newest);  // ends the lease of the one before
    }
    return all;
  }

 private:
  std::array<ipc::Reader<msg::ContentPicture>, msg::kMaxHands> readers_;
  std::array<std::optional<ipc::Sample<msg::ContentPicture>>, msg::kMaxHands> shown_;
};

}  // namespace handcast::projector
