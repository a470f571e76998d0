// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/operators.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace handcast::landmarks::onednn {

namespace {

const std::vector<Operator>& table() {
  static const std::vector<Operator> all = [] {
    std::vector<Operator> list;
    for (const auto& part :
         {convolution_operators(), pooling_operators(), arithmetic_operators(), layout_operators()})
      list.insert(list.end(), part.begin(), part.end());
    std::sort(list.begin(), list.end(), [](const Operator& a, const Operator& b) {
      return std::string_view(a.name) < b.name;
    });
    return list;
  }();
  return all;
}

}  // namespace

const std::string& output_of(const Node& node, std::span<const Node> tail, std::size_t taken) {
  return taken == 0 ? node.outputs[0] : tail[taken - 1].outputs[0];
}

std::size_t emit(Builder& builder, const Node& node, std::span<const Node> tail) {
  const auto found = std::find_if(table().begin(), table().end(),
                                  [&](const Operator& entry) { return node.op == entry.name; });
  if (found != table().end()) return found->emit(builder, node, tail);
  std::vector<std::string_view> names;
  for (const Operator& entry : table()) names.emplace_back(entry.name);
  throw Refused{fmt::format("it uses the operator {}, which is not supported; supported are {}",
                            node.op, fmt::join(names, ", "))};
}

}  // namespace handcast::landmarks::onednn
