// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::gallery {

/// One picture of each content, with its name below, in rows of equal pictures.
class ContactSheet {
 public:
  /// Adds a picture, all of one size.
  void add(const std::string& name, const renderer::Texture& picture);
  bool empty() const { return cells_.empty(); }
  /// The sheet: at most four in a row. Levels have 5 bits, so that a PNG file is small.
  renderer::Texture drawn() const;

 private:
  struct Cell {
    std::string name;
    renderer::Texture picture;
  };
  std::vector<Cell> cells_;
};

}  // namespace handcast::gallery
