// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "renderer/hand/gltf_file.hpp"

namespace handcast::renderer {

/// Triangles of a hand, whose vertices have numbers of 16 bits.
constexpr std::size_t kMaxTriangles = 65534;

/// Reads accessors, which tinygltf does not check, as rows of `width` numbers. An accessor that
/// cannot be read gives an empty vector; the reason of the first failure is kept.
class ArrayReader {
 public:
  explicit ArrayReader(const tinygltf::Model& model) : model_(model) {}

  /// All numbers of an accessor, row by row; integers flagged as normalised become 0..1. `what`
  /// names them in messages. For float and std::uint32_t.
  template <class T>
  std::vector<T> read(int accessor_index, int width, const char* what);
  /// The first reason, the end of a sentence; empty if all could be read.
  const std::optional<std::string>& trouble() const { return trouble_; }
  void complain(std::string what) {
    if (!trouble_) trouble_ = std::move(what);
  }

 private:
  struct Rows {
    const unsigned char* data;
    std::size_t stride;
  };
  std::optional<Rows> locate(int index, int width, const char* what);

  const tinygltf::Model& model_;
  std::optional<std::string> trouble_;
};

}  // namespace handcast::renderer
