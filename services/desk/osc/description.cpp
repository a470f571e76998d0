// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/description.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/settings/document.hpp"
#include "services/desk/controls/control_value.hpp"

namespace handcast::desk::osc {
namespace {

using nlohmann::json;

enum Access { kNone = 0, kRead = 1, kWrite = 2 };

json as_json(const config::Value& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag;
  if (const auto* whole = std::get_if<std::int64_t>(&value.data)) return *whole;
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
  return nullptr;
}

/// The arguments that stand for a value.
json list_of(const config::Value& value) {
  auto list = json::array();
  if (const auto* elements = std::get_if<config::Array>(&value.data))
    for (const auto& element : *elements) list.push_back(as_json(element));
  else
    list.push_back(as_json(value));
  return list;
}

/// The type tags of a control with so many values.
std::string types_of(Kind kind, std::size_t count) {
  switch (kind) {
    case Kind::toggle:
      return "T";
    case Kind::whole:
      return "i";
    case Kind::number:
      return "f";
    case Kind::numbers:
      return std::string(count, 'f');
    case Kind::texts:
      return std::string(count, 's');
    default:
      return "s";
  }
}

/// What one argument may be; empty if it may be anything.
json range_of(const Control& control) {
  auto range = json::object();
  if (!control.words.empty()) range["VALS"] = control.words;
  if (std::isfinite(control.range.min)) range["MIN"] = control.range.min;
  if (std::isfinite(control.range.max)) range["MAX"] = control.range.max;
  return range;
}

/// The node at an address, made with those above it.
json& node_at(json& root, std::string_view address) {
  json* node = &root;
  for (std::size_t begin = 1; begin < address.size();) {
    const auto end = std::min(address.find('/', begin), address.size());
    node = &(*node)["CONTENTS"][std::string(address.substr(begin, end - begin))];
    (*node)["FULL_PATH"] = address.substr(0, end);
    if (!node->contains("ACCESS")) (*node)["ACCESS"] = static_cast<int>(kNone);
    begin = end + 1;
  }
  return *node;
}

void add_control(json& root, const Control& control, const std::string& toml) {
  auto address = "/" + control.path;
  for (auto& character : address)
    if (character == '.') character = '/';
  auto& node = node_at(root, address);
  const auto values = list_of(read_value(toml));
  node["TYPE"] = types_of(control.kind, values.size());
  node["ACCESS"] = kRead | kWrite;
  node["VALUE"] = values;
  node["DESCRIPTION"] = control.sentence;
  if (const auto range = range_of(control); !range.empty())
    node["RANGE"] = std::vector<json>(values.size(), range);
}

void add_command(json& root, const std::string& address, const char* type, const char* sentence) {
  auto& node = node_at(root, address);
  node["TYPE"] = type;
  node["ACCESS"] = static_cast<int>(kWrite);
  node["DESCRIPTION"] = sentence;
}

json tree_of(std::span<const Control> controls, const Values& values,
             std::span<const std::string> presets) {
  json root{{"FULL_PATH", "/"}, {"ACCESS", static_cast<int>(kNone)}, {"DESCRIPTION", "handcast"}};
  struct Command {
    const char *address, *type, *sentence;
  };
  constexpr std::array<Command, 10> kCommands{
      {{"/content/left", "s", "What is on the left hand."},
       {"/content/right", "s", "What is on the right hand."},
       {"/content/both", "s", "What is on both hands."},
       {"/cue/go", "I", "Starts the next cue."},
       {"/cue/back", "I", "Starts the cue before the current one."},
       {"/cue/hold", "I", "Stops fades and triggers, or lets them go on."},
       {"/cue/jump", "s", "Starts the cue with this name or number."},
       {"/undo", "I", "Takes back the last change."},
       {"/redo", "I", "Does it again."},
       {"/refresh", "I", "Sends the values of all settings."}}};
  for (const auto& command : kCommands)
    add_command(root, command.address, command.type, command.sentence);
  for (const auto& preset : presets) add_command(root, "/preset/" + preset, "I", "Loads a preset.");
  for (std::size_t i = 0; i < controls.size() && i < values.toml.size(); ++i)
    add_control(root, controls[i], values.toml[i]);
  return root;
}

json host_info(const Host& host) {
  return {
      {"NAME", host.name},
      {"OSC_PORT", host.port},
      {"OSC_TRANSPORT", "UDP"},
      {"EXTENSIONS", {{"ACCESS", true}, {"VALUE", true}, {"RANGE", true}, {"DESCRIPTION", true}}}};
}

std::string print(const json& object) {
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::optional<std::string> describe_address(std::string_view query, const Host& host,
                                            std::span<const Control> controls, const Values& values,
                                            std::span<const std::string> presets) {
  const auto mark = query.find('?');
  auto address = query.substr(0, mark);
  const auto attribute = mark == query.npos ? "" : query.substr(mark + 1);
  if (attribute == "HOST_INFO") return print(host_info(host));
  const auto root = tree_of(controls, values, presets);
  const json* node = &root;
  while (address.starts_with('/')) address.remove_prefix(1);
  while (!address.empty()) {
    const auto name = std::string(address.substr(0, address.find('/')));
    const auto contents = node->find("CONTENTS");
    if (contents == node->end() || !contents->contains(name)) return std::nullopt;
    node = &(*contents)[name];
    address.remove_prefix(std::min(name.size() + 1, address.size()));
  }
  if (attribute.empty()) return print(*node);
  const auto found = node->find(std::string(attribute));
  return found == node->end() ? "" : print({{std::string(attribute), *found}});
}

}  // namespace handcast::desk::osc
