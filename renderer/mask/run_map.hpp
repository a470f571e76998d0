// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The connected parts (8 neighbours) of a binary image, as runs of lit pixels joined by
/// union-find. There are about ten times fewer runs than pixels, so a hand is labelled in
/// microseconds. The root run of a part represents it. One thread.
class RunMap {
 public:
  /// Adjacent lit pixels of a row.
  struct Run {
    /// Pixels [x0, x1) of row y.
    /// @{
    int y, x0, x1;
    /// @}
    int parent;           ///< index of a run nearer to the root; its own if it is the root
    int area;             ///< pixels of the part; valid in the root
    std::uint8_t owners;  ///< bit h: claimed by owner h; valid in the root
  };

  /// Allocates the memory for any image of this size in pixels.
  void reserve(int width, int height);
  /// Reads `region` of `image` (0 or 255).
  void build(View<const std::uint8_t> image, Rect region);
  /// The same in steps: begin(), then for each row of the region, from the top: read() for each
  /// part [x0, x1) of the row, from the left, then end_row().
  /// @{
  void begin(Rect region);
  void read(const std::uint8_t* row, int y, int x0, int x1);
  void end_row(int y);
  /// @}
  /// Reads the inverse of `other`: the pixels of its region that are not in its runs.
  void build_rest(const RunMap& other);

  /// Adds `owner` to all parts that touch the edge of the region.
  void own_edges(int owner);

  /// The root of the part at a pixel; -1 if the pixel is dark or outside the region.
  int part_at(int x, int y);
  /// The root of the largest part that touches `region`; -1 if there is none.
  int largest_part(Rect region);

  /// The root of a run's part.
  int part_of(const Run& run) { return root(run.parent); }
  /// Adds an owner, 0..7, to the part with the root `part`.
  void add_owner(int part, int hint) {
    runs_[part].owners = static_cast<std::uint8_t>(runs_[part].owners | 1u << hint);
  }
  /// The owners of a run's part: bit h for owner h.
  std::uint8_t owners(const Run& run) { return runs_[root(run.parent)].owners; }
  /// The number of pixels in a run's part.
  int area(const Run& run) { return runs_[root(run.parent)].area; }
  /// All runs, row by row from the top, left to right. An index into it names a run.
  const std::vector<Run>& runs() const { return runs_; }

 private:
  void push(int y, int x0, int x1);
  int root(int run);
  void join(int a, int b);
  void join_with_row_above(int above_first, int above_end);

  Rect region_;
  std::vector<Run> runs_;
  std::vector<int> row_first_;  ///< index of the first run of each row, and one past the last
};

}  // namespace handcast::renderer
