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

/// The extents of a tensor; a scalar has none.
using Shape = std::vector<std::int64_t>;

/// The most elements of a tensor. Networks for one core have far fewer; a file with more is
/// damaged.
constexpr std::int64_t kMostElements = std::int64_t{1} << 26;

/// The product of the extents; 0 if an extent is below 1 or the product above kMostElements.
std::int64_t elements(const Shape& shape);
/// "[1,3,224,224]".
std::string to_string(const Shape& shape);

/// A constant: floats or integers (shapes, axes); the other list is empty.
struct Tensor {
  Shape shape;                         ///< its extents
  std::vector<float> floats;           ///< its elements, row-major
  std::vector<std::int64_t> integers;  ///< its elements, row-major
};

/// An attribute of a node. Its kind says which member holds the value.
struct Attribute {
  /// AttributeProto.AttributeType of the file.
  enum Kind : int {
    kNumber = 1,
    kInteger = 2,
    kText = 3,
    kTensor = 4,
    kNumbers = 6,
    kIntegers = 7
  };
  Kind kind = kInteger;                ///< which of the members below is set
  std::int64_t integer = 0;            ///< of kInteger
  float number = 0;                    ///< of kNumber
  std::string text;                    ///< of kText
  std::vector<std::int64_t> integers;  ///< of kIntegers
  std::vector<float> numbers;          ///< of kNumbers
  Tensor tensor;                       ///< of kTensor
};

/// A node of the graph.
struct Node {
  std::string op;                    ///< the name of its operator
  std::vector<std::string> inputs;   ///< names of values; "": an optional input that is absent
  std::vector<std::string> outputs;  ///< names of its results
  std::map<std::string, Attribute> attributes;  ///< its attributes by name

  /// True if it has this attribute.
  bool has(const std::string& attribute) const { return attributes.contains(attribute); }
  /// The value of an attribute; `otherwise` if the node does not have it.
  /// @{
  std::int64_t integer(const std::string& attribute, std::int64_t otherwise) const;
  float number(const std::string& attribute, float otherwise) const;
  std::string text(const std::string& attribute, const std::string& otherwise) const;
  std::vector<std::int64_t> integers(const std::string& attribute,
                                     const std::vector<std::int64_t>& otherwise) const;
  /// @}
  /// True if it has input `i`.
  bool has_input(std::size_t i) const { return i < inputs.size() && !inputs[i].empty(); }
  /// "Conv 'name of its first output'", for messages.
  std::string title() const;
};

/// An input or an output of the network.
struct Port {
  std::string name;  ///< name of its value
  Shape shape;       ///< its extents; 1 for a free batch size
};

/// The parts of an ONNX file that handcast uses. Each value is computed by one node, and nodes come
/// after those that compute their inputs.
struct Model {
  std::int64_t opset = 0;                   ///< version of the operator set
  std::vector<Node> nodes;                  ///< the graph
  std::map<std::string, Tensor> constants;  ///< weights and other constants by name
  /// The inputs and outputs of the network.
  /// @{
  std::vector<Port> inputs, outputs;
  /// @}
};

/// Reads and checks a file. Errors: bad_config, a sentence that begins with the file's name.
Result<Model> read_model(const std::filesystem::path& file);
/// The same from memory; errors do not name a file.
Result<Model> parse_model(std::span<const std::uint8_t> bytes);
/// Checks that the graph is valid: fixed extents, each value computed once and before it is used,
/// finite constants. Errors: bad_config.
Result<void> check_model(const Model& model);

}  // namespace handcast::landmarks::onnx
