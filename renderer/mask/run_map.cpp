// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/run_map.hpp"

#include <bit>
#include <cstring>

namespace handcast::renderer {
namespace {

std::uint64_t load8(const std::uint8_t* bytes) {
  std::uint64_t word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

/// The first pixel in [x, end) that is not `value` (0 or 255); `end` if all are.
int skip(const std::uint8_t* row, int x, int end, std::uint8_t value) {
  const std::uint64_t all = value ? ~0ull : 0ull;
  for (; x + 8 <= end; x += 8)
    if (const std::uint64_t other = load8(row + x) ^ all) return x + std::countr_zero(other) / 8;
  while (x < end && row[x] == value) ++x;
  return x;
}

}  // namespace

void RunMap::reserve(int width, int height) {
  const auto rows = static_cast<std::size_t>(height);
  runs_.reserve(rows * (static_cast<std::size_t>(width) + 1) / 2);  // every second pixel is lit
  row_first_.reserve(rows + 1);
}

void RunMap::build(View<const std::uint8_t> image, Rect region) {
  begin(region);
  for (int y = region.y0; y < region.y1; ++y) {
    read(image.row(y), y, region.x0, region.x1);
    end_row(y);
  }
}

void RunMap::begin(Rect region) {
  region_ = region;
  runs_.clear();
  row_first_.assign(1, 0);
}

void RunMap::push(int y, int x0, int x1) {
  const int index = static_cast<int>(runs_.size());
  runs_.push_back({y, x0, x1, index, x1 - x0, 0});
}

void RunMap::read(const std::uint8_t* row, int y, int x0, int x1) {
  for (int x = skip(row, x0, x1, 0); x < x1;) {
    const int end = skip(row, x, x1, 255);
    push(y, x, end);
    x = skip(row, end, x1, 0);
  }
}

void RunMap::end_row(int y) {
  if (y > region_.y0)
    join_with_row_above(row_first_[y - region_.y0 - 1], row_first_[y - region_.y0]);
  row_first_.push_back(static_cast<int>(runs_.size()));
}

void RunMap::build_rest(const RunMap& other) {
  begin(other.region_);
  for (int y = region_.y0; y < region_.y1; ++y) {
    int x = region_.x0;
    for (int run = other.row_first_[y - region_.y0]; run < other.row_first_[y - region_.y0 + 1];
         ++run) {
      if (other.runs_[run].x0 > x) push(y, x, other.runs_[run].x0);
      x = other.runs_[run].x1;
    }
    if (x < region_.x1) push(y, x, region_.x1);
    end_row(y);
  }
}

void RunMap::own_edges(int owner) {
  for (int run = 0; run < static_cast<int>(runs_.size()); ++run) {
    const Run& r = runs_[run];
    if (r.y == region_.y0 || r.y == region_.y1 - 1 || r.x0 == region_.x0 || r.x1 == region_.x1)
      add_owner(root(run), owner);
  }
}

/// The runs from `above_end` on are those of the newest row.
void RunMap::join_with_row_above(int above_first, int above_end) {
  int above = above_first;
  for (int here = above_end; here < static_cast<int>(runs_.size()); ++here) {
    while (above < above_end && runs_[above].x1 < runs_[here].x0) ++above;
    for (int touching = above; touching < above_end && runs_[touching].x0 <= runs_[here].x1;
         ++touching)
      join(touching, here);
  }
}

int RunMap::root(int run) {
  while (runs_[run].parent != run) {
    runs_[run].parent = runs_[runs_[run].parent].parent;
    run = runs_[run].parent;
  }
  return run;
}

void RunMap::join(int a, int b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  runs_[b].parent = a;
  runs_[a].area += runs_[b].area;
}

int RunMap::part_at(int x, int y) {
  if (x < region_.x0 || x >= region_.x1 || y < region_.y0 || y >= region_.y1) return -1;
  for (int run = row_first_[y - region_.y0]; run < row_first_[y - region_.y0 + 1]; ++run)
    if (x >= runs_[run].x0 && x < runs_[run].x1) return root(run);
  return -1;
}

int RunMap::largest_part(Rect region) {
  int largest = -1;
  for (int run = 0; run < static_cast<int>(runs_.size()); ++run) {
    const Run& r = runs_[run];
    if (r.y < region.y0 || r.y >= region.y1 || r.x1 <= region.x0 || r.x0 >= region.x1) continue;
    const int part = root(run);
    if (largest < 0 || runs_[part].area > runs_[largest].area) largest = part;
  }
  return largest;
}

}  // namespace handcast::renderer
