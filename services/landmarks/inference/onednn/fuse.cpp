// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/fuse.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

namespace handcast::landmarks::onednn {

namespace {

using onnx::Node;

bool can_follow(const Node& node) {
  static constexpr std::array<std::string_view, 8> kOps{
      "Add", "Relu", "Clip", "PRelu", "LeakyRelu", "Sigmoid", "Tanh", "HardSwish"};
  return std::find(kOps.begin(), kOps.end(), node.op) != kOps.end();
}

/// The users of each value: numbers of nodes, and -1 for an output of the network.
using Users = std::map<std::string, std::vector<int>>;

Users users_of(const onnx::Model& model) {
  Users users;
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i)
    for (const std::string& input : model.nodes[i].inputs) users[input].push_back(i);
  for (const onnx::Port& port : model.outputs) users[port.name].push_back(-1);
  return users;
}

/// The node that may join a group whose result is `value`: the only user of the value, an addition
/// or an activation of it.
std::optional<int> next_in_chain(const onnx::Model& model, const Users& users,
                                 const std::string& value) {
  const auto found = users.find(value);
  if (found == users.end() || found->second.size() != 1 || found->second[0] < 0)
    return std::nullopt;
  const Node& node = model.nodes[found->second[0]];
  const bool takes_it = node.op == "Add" || (!node.inputs.empty() && node.inputs[0] == value);
  if (!can_follow(node) || !takes_it || node.outputs.size() != 1) return std::nullopt;
  return found->second[0];
}

Group group_led_by(int head, const onnx::Model& model, const Users& users, std::vector<bool>& taken,
                   int& place) {
  Group group{model.nodes[head], {}};
  taken[place = head] = true;
  while (const auto next = next_in_chain(model, users, group.output())) {
    if (taken[*next]) break;
    taken[place = *next] = true;
    group.tail.push_back(model.nodes[place]);
  }
  return group;
}

}  // namespace

/// A group takes the place of its last node in the order, so that the other operands of its
/// additions are computed before it. If two chains meet in an addition, it joins the later one;
/// convolutions are grouped before additions.
std::vector<Group> fuse(const onnx::Model& model) {
  const Users users = users_of(model);
  std::vector<bool> taken(model.nodes.size(), false);
  std::map<int, Group> by_place;
  for (const auto& leaders :
       {std::vector<std::string_view>{"Conv", "ConvTranspose", "Gemm"}, {"Add"}}) {
    for (int i = static_cast<int>(model.nodes.size()) - 1, place = 0; i >= 0; --i) {
      if (taken[i] || std::find(leaders.begin(), leaders.end(), model.nodes[i].op) == leaders.end())
        continue;
      Group group = group_led_by(i, model, users, taken, place);
      by_place.emplace(place, std::move(group));
    }
  }
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (!taken[i]) by_place.emplace(i, Group{model.nodes[i], {}});
  std::vector<Group> groups;
  groups.reserve(by_place.size());
  for (auto& [place, group] : by_place) groups.push_back(std::move(group));
  return groups;
}

}  // namespace handcast::landmarks::onednn
