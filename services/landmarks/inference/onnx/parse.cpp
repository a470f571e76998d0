// SPDX-License-Identifier: Apache-2.0
// Field numbers: onnx.proto of the ONNX project, IR version 3 and up.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/base/input_file.hpp"
#include "services/landmarks/inference/onnx/check.hpp"
#include "services/landmarks/inference/onnx/model.hpp"
#include "services/landmarks/inference/onnx/wire.hpp"

namespace handcast::landmarks::onnx {

namespace {

/// An exception inside this file: parse_model() turns it into an error.
struct Broken {
  std::string what;
};

[[noreturn]] void broken(std::string what) { throw Broken{std::move(what)}; }

/// Calls `visit` with each field of a message.
template <class Visit>
void each_field(Bytes message, const char* what, Visit&& visit) {
  WireReader reader(message);
  while (const auto field = reader.next()) visit(*field);
  if (reader.broken())
    broken(fmt::format("it is not an ONNX file, or damaged (the {} is cut off)", what));
}

void append_integers(const Field& field, std::vector<std::int64_t>& list) {
  if (!field.is_bytes) return list.push_back(field.integer());
  WireReader packed(field.bytes);
  while (!packed.at_end()) {
    const auto value = packed.varint();
    if (!value) broken("it is damaged (a list of integers is cut off)");
    list.push_back(static_cast<std::int64_t>(*value));
  }
}

/// The little-endian numbers of `bytes`.
template <class T>
std::vector<T> numbers_of(Bytes bytes) {
  if (bytes.size() % sizeof(T) != 0) broken("it is damaged (a list of numbers is cut off)");
  std::vector<T> numbers(bytes.size() / sizeof(T));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

template <class T, class U>
void append(const std::vector<U>& from, std::vector<T>& to) {
  to.reserve(to.size() + from.size());
  for (const U value : from) to.push_back(static_cast<T>(value));
}

void append_floats(const Field& field, std::vector<float>& list) {
  if (field.is_bytes) return append(numbers_of<float>(field.bytes), list);
  list.push_back(field.number32());
}

float half_to_float(std::uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const float sign = half & 0x8000 ? -1.f : 1.f;
  if (exponent == 31) return mantissa ? std::nanf("") : sign * INFINITY;
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(mantissa), -24);
  return sign * std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
}

enum DataType { kFloat = 1, kInt32 = 6, kInt64 = 7, kBool = 9, kFloat16 = 10, kDouble = 11 };

void append_raw(Bytes raw, std::int64_t type, Tensor& tensor) {
  switch (type) {
    case kFloat:
      return append(numbers_of<float>(raw), tensor.floats);
    case kDouble:
      return append(numbers_of<double>(raw), tensor.floats);
    case kInt32:
      return append(numbers_of<std::int32_t>(raw), tensor.integers);
    case kInt64:
      return append(numbers_of<std::int64_t>(raw), tensor.integers);
    case kBool:
      return append(numbers_of<std::uint8_t>(raw), tensor.integers);
    case kFloat16:
      for (const std::uint16_t half : numbers_of<std::uint16_t>(raw))
        tensor.floats.push_back(half_to_float(half));
      return;
    default:
      broken(
          fmt::format("a constant has type {}; supported are float, float16, double, int32, "
                      "int64 and bool",
                      type));
  }
}

void check_size(const Tensor& tensor, const std::string& name) {
  if (!tensor.floats.empty() && !tensor.integers.empty())
    broken(fmt::format("the constant '{}' has both integers and floats", name));
  const std::size_t given = tensor.floats.size() + tensor.integers.size();
  // Exporters write an empty list for "no region"; elements() is also 0 for a tensor that is too
  // large.
  const bool of_nothing = std::ranges::find(tensor.shape, 0) != tensor.shape.end();
  if (given != static_cast<std::size_t>(elements(tensor.shape)) || (given == 0 && !of_nothing))
    broken(fmt::format("the constant '{}' is declared as {} and has {} values", name,
                       to_string(tensor.shape), given));
}

Tensor read_tensor(Bytes message, std::string& name) {
  Tensor tensor;
  std::int64_t type = 0;
  Bytes raw;
  bool outside = false;
  std::vector<std::int64_t> words;
  each_field(message, "constant", [&](const Field& field) {
    switch (field.number) {
      case 1:
        append_integers(field, tensor.shape);
        break;
      case 2:
        type = field.integer();
        break;
      case 4:
        append_floats(field, tensor.floats);
        break;
      case 5:
        append_integers(field, words);
        break;
      case 7:
        append_integers(field, tensor.integers);
        break;
      case 8:
        name = field.text();
        break;
      case 9:
        raw = field.bytes;
        break;
      case 10:
        append(numbers_of<double>(field.bytes), tensor.floats);
        break;
      case 14:
        outside = field.value == 1;
        break;
      default:
        break;
    }
  });
  if (outside)
    broken(fmt::format("the constant '{}' is in another file, which is not supported", name));
  append_raw(raw, type, tensor);
  for (const std::int64_t word : words) {
    if (type == kFloat16)
      tensor.floats.push_back(half_to_float(static_cast<std::uint16_t>(word)));
    else
      tensor.integers.push_back(word);
  }
  check_size(tensor, name);
  return tensor;
}

std::pair<std::string, Attribute> read_attribute(Bytes message) {
  std::string name, unused;
  Attribute attribute;
  bool has_tensor = false;
  each_field(message, "attribute", [&](const Field& field) {
    switch (field.number) {
      case 1:
        name = field.text();
        break;
      case 2:
        attribute.number = field.number32();
        break;
      case 3:
        attribute.integer = field.integer();
        break;
      case 4:
        attribute.text = field.text();
        break;
      case 5:
        attribute.tensor = read_tensor(field.bytes, unused);
        has_tensor = true;
        break;
      case 7:
        append_floats(field, attribute.numbers);
        break;
      case 8:
        append_integers(field, attribute.integers);
        break;
      case 20:
        attribute.kind = static_cast<Attribute::Kind>(field.value & 15);
        break;
      default:
        break;
    }
  });
  if (attribute.kind == Attribute::kTensor && !has_tensor)
    broken(fmt::format("it is damaged (the attribute '{}' has no value)", name));
  return {std::move(name), std::move(attribute)};
}

Node read_node(Bytes message) {
  Node node;
  each_field(message, "node", [&](const Field& field) {
    switch (field.number) {
      case 1:
        node.inputs.push_back(field.text());
        break;
      case 2:
        node.outputs.push_back(field.text());
        break;
      case 4:
        node.op = field.text();
        break;
      case 5:
        node.attributes.insert(read_attribute(field.bytes));
        break;
      default:
        break;
    }
  });
  return node;
}

/// TensorShapeProto. A free extent (one with a name, or with neither) is 0.
Shape read_shape(Bytes message) {
  Shape shape;
  each_field(message, "shape", [&](const Field& field) {
    if (field.number != 1) return;
    std::int64_t extent = 0;
    each_field(field.bytes, "shape", [&](const Field& part) {
      if (part.number == 1) extent = part.integer();
    });
    shape.push_back(extent);
  });
  return shape;
}

/// ValueInfoProto > TypeProto > its tensor type > its shape.
Port read_port(Bytes message) {
  Port port;
  each_field(message, "port", [&](const Field& field) {
    if (field.number == 1) port.name = field.text();
    if (field.number != 2) return;
    each_field(field.bytes, "type", [&](const Field& type) {
      if (type.number != 1) return;
      each_field(type.bytes, "type", [&](const Field& part) {
        if (part.number == 2) port.shape = read_shape(part.bytes);
      });
    });
  });
  if (!port.shape.empty() && port.shape[0] == 0) port.shape[0] = 1;
  return port;
}

void add_constant(Model& model, const std::string& name, Tensor tensor) {
  if (!model.constants.emplace(name, std::move(tensor)).second)
    broken(fmt::format("the constant '{}' is given twice", name));
}

void add_node(Model& model, Node node) {
  if (node.op != "Constant") return model.nodes.push_back(std::move(node));
  if (node.outputs.size() != 1 || !node.has("value"))
    broken(fmt::format("{} has no tensor as its value", node.title()));
  add_constant(model, node.outputs[0], std::move(node.attributes["value"].tensor));
}

void read_graph(Bytes message, Model& model) {
  each_field(message, "graph", [&](const Field& field) {
    switch (field.number) {
      case 1:
        add_node(model, read_node(field.bytes));
        break;
      case 5: {
        std::string name;
        Tensor tensor = read_tensor(field.bytes, name);
        add_constant(model, name, std::move(tensor));
        break;
      }
      case 11:
        model.inputs.push_back(read_port(field.bytes));
        break;
      case 12:
        model.outputs.push_back(read_port(field.bytes));
        break;
      default:
        break;
    }
  });
  // Before IR version 4, constants are listed among the inputs, too.
  std::erase_if(model.inputs,
                [&](const Port& port) { return model.constants.contains(port.name); });
}

void read_opset(Bytes message, Model& model) {
  std::string domain;
  std::int64_t version = 0;
  each_field(message, "operator set", [&](const Field& field) {
    if (field.number == 1) domain = field.text();
    if (field.number == 2) version = field.integer();
  });
  if (domain.empty() || domain == "ai.onnx") model.opset = version;
}

}  // namespace

Result<Model> parse_model(std::span<const std::uint8_t> bytes) try {
  Model model;
  bool has_graph = false;
  each_field(bytes, "model", [&](const Field& field) {
    if (field.number == 8) read_opset(field.bytes, model);
    if (field.number != 7) return;
    if (std::exchange(has_graph, true)) broken("it has two graphs");
    read_graph(field.bytes, model);
  });
  if (!has_graph) broken("it is not an ONNX file: it has no graph");
  if (auto sound = check_model(model); !sound) return tl::make_unexpected(sound.error());
  return model;
} catch (const Broken& error) {
  return fail(Errc::bad_config, error.what);
}

Result<Model> read_model(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostModel);
  if (!bytes) return fail_in("network", bytes.error());
  auto model = parse_model({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
  if (!model) return fail_in(fmt::format("network '{}'", file.string()), model.error());
  return model;
}

}  // namespace handcast::landmarks::onnx
