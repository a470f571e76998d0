// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The connected parts (8 neighbours) of a binary image, as runs of lit pixels row by row joined by
/// union-find: a tenth of the pixels' number, so that labelling a hand takes microseconds.
class RunMap {
 public:
  struct Run {
    int y, x0, x1;        ///< pixels [x0, x1) of row y
    int parent;           ///< towards the run that stands for the part
    int area;             ///< of the part; valid where the run stands for it
    std::uint8_t owners;  ///< bit h: wanted by hint h; valid where the run stands for its part
  };

  /// Reads `region` of `image` (0 or 255).
  void build(View<const std::uint8_t> image, Rect region);
  /// The same in steps: begin(), then for every row of the region, from the top, its parts that are
  /// to be read, and end_row().
  void begin(Rect region);
  void read(const std::uint8_t* row, int y, int x0, int x1);
  void end_row(int y);
  /// What `other` has not, in its region.
  void build_rest(const RunMap& other);

  /// Marks all parts that reach the edge of the region as owned by `owner`.
  void own_edges(int owner);

  /// The run that stands for the part at a pixel; -1 where the pixel is dark or outside.
  int part_at(int x, int y);
  /// The run that stands for the largest part that touches `region`; -1: none.
  int largest_part(Rect region);

  int part_of(const Run& run) { return root(run.parent); }
  void add_owner(int part, int hint) {
    runs_[part].owners = static_cast<std::uint8_t>(runs_[part].owners | 1u << hint);
  }
  std::uint8_t owners(const Run& run) { return runs_[root(run.parent)].owners; }
  int area(const Run& run) { return runs_[root(run.parent)].area; }
  const std::vector<Run>& runs() const { return runs_; }

 private:
  void push(int y, int x0, int x1);
  int root(int run);
  void join(int a, int b);
  void join_with_row_above(int above_first, int above_end);

  Rect region_;
  std::vector<Run> runs_;
  std::vector<int> row_first_;  ///< index of each row's first run, and one past the last row's
};

}  // namespace handcast::renderer
