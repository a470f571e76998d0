// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onnx/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace handcast::landmarks::onnx {

namespace {

template <class T>
T value_or(const Node& node, const std::string& attribute, T Attribute::*member, T otherwise) {
  const auto found = node.attributes.find(attribute);
  return found == node.attributes.end() ? otherwise : found->second.*member;
}

}  // namespace

std::int64_t elements(const Shape& shape) {
  std::int64_t count = 1;
  for (const std::int64_t extent : shape) {
    if (extent < 1 || extent > kMostElements / count) return 0;
    count *= extent;
  }
  return count;
}

std::string to_string(const Shape& shape) { return fmt::format("[{}]", fmt::join(shape, ",")); }

std::int64_t Node::integer(const std::string& attribute, std::int64_t otherwise) const {
  return value_or(*this, attribute, &Attribute::integer, otherwise);
}

float Node::number(const std::string& attribute, float otherwise) const {
  return value_or(*this, attribute, &Attribute::number, otherwise);
}

std::string Node::text(const std::string& attribute, const std::string& otherwise) const {
  return value_or(*this, attribute, &Attribute::text, otherwise);
}

std::vector<std::int64_t> Node::integers(const std::string& attribute,
                                         const std::vector<std::int64_t>& otherwise) const {
  return value_or(*this, attribute, &Attribute::integers, otherwise);
}

std::string Node::title() const {
  return fmt::format("{} '{}'", op, outputs.empty() ? "" : outputs[0]);
}

}  // namespace handcast::landmarks::onnx
