// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "services/content/chain.hpp"

namespace handcast::content {

/// The content of one hand: shows a chain, and changes to another one by a transition. One thread.
class Mixer {
 public:
  /// Shows nothing (transparent) until the first change. `like`: size, side and meshes.
  explicit Mixer(Opening like, OpenSource open_source = content::open_source);

  /// Changes to another chain of the same size, from what is shown now. `transition`: "cut";
  /// "fade" (see fade()); or a source of two inputs, as it is written in a chain ("isf:wipe.fs
  /// softness=0.2"). It begins with the next picture. Errors: those of opening the transition,
  /// bad_config (it is none); then nothing changes.
  Result<void> change(Chain next, std::string_view transition, double seconds);

  /// Draws the picture of a time, in seconds of any clock that goes on evenly. `camera`: see
  /// Moment. Returns false if
  /// picture() is the same as before. Errors, for a person: those of the chains; the picture goes
  /// on and may have changed. A new chain that fails during its transition is dropped, and the old
  /// one stays, unless the error is bad_data or a timeout.
  Result<bool> draw(const HandState& hand, const HandState& other, double time_s,
                    const CameraView* camera = nullptr);

  /// What is shown.
  const renderer::Texture& picture() const;
  /// What the content needs of each moment.
  Needs needs() const;
  bool is_changing() const { return next_.has_value(); }
  /// The chain that is shown, or will be after the change; null before the first one.
  Chain* chain();

 private:
  struct Shown {
    Chain chain;
    renderer::Texture picture;
    double opened_s = 0, drawn_s = 0;
    std::uint64_t calls = 0;
  };

  Result<bool> draw(Shown& shown, Moment moment, double time_s);
  Result<bool> draw_change(const Moment& moment, double time_s);
  Result<void> draw_between(Pixels from, Moment moment, double time_s);
  void end_change();

  Opening like_;
  OpenSource open_source_;
  std::optional<Shown> now_, next_;
  renderer::Texture between_;                ///< the picture of a change; before all, transparent
  std::optional<renderer::Texture> frozen_;  ///< what a change broke into: it begins with that
  std::unique_ptr<Source> transition_;       ///< null: fade
  double seconds_ = 0;                       ///< that the change takes
  std::optional<double> began_s_;            ///< its first picture
  double between_s_ = 0;                     ///< its last picture
  std::uint64_t between_count_ = 0;
};

}  // namespace handcast::content
