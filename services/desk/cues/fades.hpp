// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/cues/cue_list.hpp"

namespace handcast::desk::cues {

/// The numbers of one cue on their way. One thread.
class Fades {
 public:
  /// Begins the fades of a cue, which must outlive them, from the present values.
  void begin(const Cue& cue, std::span<const Control> controls, const Values& values);
  /// The assignments at a time since the start of the cue. `values`: the present ones; `source`:
  /// who set the former ones. A number that somebody else has changed on the way is left alone from
  /// then on.
  std::vector<std::string> at(double elapsed_s, std::span<const Control> controls,
                              const Values& values, std::string_view source);
  /// What at() gave last was set; those that have arrived are over. Without it, they are tried
  /// again.
  void were_set();
  /// True if none is on its way.
  bool are_over() const { return fades_.empty(); }
  /// Forgets them.
  void stop() { fades_.clear(); }

 private:
  struct Fade {
    const Target* target;
    std::vector<double> from;
    std::vector<double> set, asked;  ///< the last ones that were set, and that at() gave
    bool has_arrived = false;
  };
  std::vector<Fade> fades_;
};

}  // namespace handcast::desk::cues
