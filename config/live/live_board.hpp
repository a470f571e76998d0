// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::config {

/// How one content becomes another; empty, negative: as content.transition and _s say.
struct Transition {
  std::string name;
  double seconds = -1;
};

/// Why the light is off, as "light.blackout is on"; "" if it is not.
std::string why_dark(const Light& light);

/// The live settings of a rig that is up, for programs that change them. Each change locks the
/// ring, reads the newest values and publishes the new ones, so that several programs can change
/// settings at the same time, and none needs the supervisor once it has the ring. One thread.
class LiveBoard {
 public:
  /// Takes the ring. `filed`: the rig of `file`, beside which presets are kept.
  LiveBoard(ipc::Segment ring, Rig filed, std::filesystem::path file);
  ~LiveBoard();
  LiveBoard(LiveBoard&& other) noexcept;
  LiveBoard& operator=(LiveBoard&& other) noexcept;
  /// Opens the board of a rig. Errors: unavailable (it is not up), bad_data (of another version).
  static Result<LiveBoard> open(const std::string& rig);

  /// The rig as its file has it.
  const Rig& filed() const { return filed_; }
  /// The newest settings, and the rig with them.
  /// @{
  Result<msg::LiveSettings> now() const;
  Result<Rig> rig_now() const;
  /// @}

  /// Changes settings: see changed_values(). `source`: who asks. Returns the number of the change
  /// (header.frame_id). Errors: bad_config, unavailable (another program holds the ring for more
  /// than 2 s).
  Result<std::uint64_t> set(std::span<const std::string> assignments, std::string_view source,
                            const Transition& transition = {});
  /// See config::undo() and config::redo(). Errors: those of set().
  /// @{
  Result<std::uint64_t> undo(std::string_view source);
  Result<std::uint64_t> redo(std::string_view source);
  /// @}

  /// Replaces all live values by those of a preset. Errors: bad_config (there is none), set().
  Result<std::uint64_t> load(std::string_view preset, std::string_view source);
  /// Keeps the present values as a preset, or, save(), for the next start of the rig. Errors:
  /// bad_config (not a name), unavailable.
  /// @{
  Result<void> store(std::string_view preset) const;
  Result<void> save() const;
  /// @}
  /// The rig file, beside which presets are kept.
  const std::filesystem::path& file() const { return file_; }

 private:
  struct View;

  Result<ipc::Segment> again() const;
  Result<std::string> kept() const;
  Result<std::uint64_t> amend(const std::function<Result<void>(msg::LiveSettings&)>& change) const;

  ipc::Segment ring_;
  mutable std::unique_ptr<View> view_;  ///< the ring as it is read; null before the first now()
  Rig filed_;
  std::filesystem::path file_;
};

}  // namespace handcast::config
