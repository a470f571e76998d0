// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "config/live/live_board.hpp"
#include "services/desk/base/panel.hpp"

namespace handcast::desk {

/// The live settings of a rig, whose values are those of its file.
std::vector<Control> controls_of(config::Rig filed);

/// The panel of a rig that is up. Values are read from the ring when they are asked for, so that
/// changes of other programs are seen.
class RigPanel final : public Panel {
 public:
  /// Takes the board of the rig.
  explicit RigPanel(config::LiveBoard board);

  std::span<const Control> controls() const override { return controls_; }
  std::shared_ptr<const Values> values() const override;
  Result<void> set(std::span<const std::string> assignments, std::string_view source) override;
  Result<void> undo(std::string_view source) override;
  Result<void> redo(std::string_view source) override;
  std::vector<std::string> presets() const override;
  Result<void> load(std::string_view preset, std::string_view source) override;
  Result<void> store(std::string_view preset) override;
  Result<void> save() override;
  Result<void> show(std::string_view hand, std::string_view content,
                    std::string_view source) override;

 private:
  Result<void> noted(const Result<std::uint64_t>& change, std::string_view what,
                     std::string_view source) const;

  mutable std::mutex mutex_;  ///< of all below
  mutable config::LiveBoard board_;
  std::vector<Control> controls_;
  mutable std::shared_ptr<const Values> values_;  ///< of the newest message that was seen
};

}  // namespace handcast::desk
