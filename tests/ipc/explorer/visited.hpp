// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace handcast::explorer {

/// The set of the hashes of visited states: an open-addressing hash table, since there are
/// millions.
class Visited {
 public:
  /// Adds a hash. Returns false if it was in the set already.
  bool insert(std::uint64_t hash) {
    if (2 * count_ >= slots_.size()) grow();
    return place(hash == 0 ? 1 : hash);
  }
  /// Number of hashes.
  std::uint64_t count() const { return count_; }

 private:
  bool place(std::uint64_t hash) {
    const auto mask = slots_.size() - 1;
    auto at = hash & mask;
    for (; slots_[at] != 0; at = (at + 1) & mask)
      if (slots_[at] == hash) return false;
    slots_[at] = hash;
    ++count_;
    return true;
  }

  void grow() {
    auto old = std::exchange(slots_, std::vector<std::uint64_t>(2 * slots_.size()));
    count_ = 0;
    for (const auto hash : old)
      if (hash != 0) place(hash);
  }

  std::vector<std::uint64_t> slots_ = std::vector<std::uint64_t>(1 << 14);
  std::uint64_t count_ = 0;
};

}  // namespace handcast::explorer
