// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::landmarks::onnx {

using Shape = std::vector<std::int64_t>;  ///< empty: a scalar

/// No tensor of a network for one core comes near it; a file that asks for more is broken.
constexpr std::int64_t kMostElements = std::int64_t{1} << 26;

/// The product of the extents; 0 where one is below 1 or the product is beyond kMostElements.
std::int64_t elements(const Shape& shape);
std::string to_string(const Shape& shape);

/// A constant: numbers, or whole numbers (shapes, axes); the other list is empty.
struct Tensor {
  Shape shape;
  std::vector<float> floats;
  std::vector<std::int64_t> integers;
};

struct Attribute {
  enum Kind : int {
    kNumber = 1,
    kInteger = 2,
    kText = 3,
    kTensor = 4,
    kNumbers = 6,
    kIntegers = 7
  };  ///< as numbered in the file
  Kind kind = kInteger;
  std::int64_t integer = 0;
  float number = 0;
  std::string text;
  std::vector<std::int64_t> integers;
  std::vector<float> numbers;
  Tensor tensor;
};

struct Node {
  std::string op;
  std::vector<std::string> inputs;  ///< an empty name: an optional input left out
  std::vector<std::string> outputs;
  std::map<std::string, Attribute> attributes;

  bool has(const std::string& attribute) const { return attributes.contains(attribute); }
  std::int64_t integer(const std::string& attribute, std::int64_t otherwise) const;
  float number(const std::string& attribute, float otherwise) const;
  std::string text(const std::string& attribute, const std::string& otherwise) const;
  std::vector<std::int64_t> integers(const std::string& attribute,
                                     const std::vector<std::int64_t>& otherwise) const;
  bool has_input(std::size_t i) const { return i < inputs.size() && !inputs[i].empty(); }
  /// "Conv 'name of its first output'", for messages.
  std::string title() const;
};

struct Port {
  std::string name;
  Shape shape;
};

/// What handcast uses of an ONNX file. Each value has one maker, and nodes stand after those that
/// make their inputs.
struct Model {
  std::int64_t opset = 0;
  std::vector<Node> nodes;
  std::map<std::string, Tensor> constants;
  std::vector<Port> inputs, outputs;  ///< a free batch is read as 1
};

/// Errors: bad_config, a sentence that starts with the file's name.
Result<Model> read_model(const std::filesystem::path& file);
/// The same from memory; errors name no file.
Result<Model> parse_model(std::span<const std::uint8_t> bytes);
/// The model as an ONNX file's bytes.
std::vector<std::uint8_t> write_model(const Model& model);

}  // namespace handcast::landmarks::onnx
