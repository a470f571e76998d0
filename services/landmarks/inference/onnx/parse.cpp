// SPDX-License-Identifier: Apache-2.0
// Fields: onnx.proto of the ONNX project, IR version 3 and up.
#include <fmt/format.h>

#define ONNX_ML 1  // the only kind that is installed
#include <onnx/onnx_pb.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/base/input_file.hpp"
#include "ipc/base/quote.hpp"
#include "services/landmarks/inference/onnx/model.hpp"

namespace handcast::landmarks::onnx {

namespace {

using ::onnx::AttributeProto, ::onnx::GraphProto, ::onnx::ModelProto, ::onnx::NodeProto,
    ::onnx::TensorProto, ::onnx::ValueInfoProto;

/// An exception inside this file: parse_model() turns it into an error.
struct Broken {
  std::string what;
};

[[noreturn]] void broken(std::string what) { throw Broken{std::move(what)}; }

float half_to_float(std::uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const float sign = half & 0x8000 ? -1.f : 1.f;
  if (exponent == 31) return mantissa ? std::nanf("") : sign * INFINITY;
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(mantissa), -24);
  return sign * std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
}

/// Appends the little-endian numbers of `raw`, which are of type `From`.
template <class From, class To>
void append_raw(const std::string& raw, std::vector<To>& to) {
  if (raw.size() % sizeof(From) != 0) broken("it is damaged (a list of numbers is cut off)");
  std::vector<From> numbers(raw.size() / sizeof(From));
  if (!numbers.empty()) std::memcpy(numbers.data(), raw.data(), raw.size());
  to.reserve(to.size() + numbers.size());
  for (const From number : numbers) to.push_back(static_cast<To>(number));
}

void append_raw(const TensorProto& from, Tensor& tensor) {
  const std::string& raw = from.raw_data();
  switch (from.data_type()) {
    case TensorProto::FLOAT:
      return append_raw<float>(raw, tensor.floats);
    case TensorProto::DOUBLE:
      return append_raw<double>(raw, tensor.floats);
    case TensorProto::INT32:
      return append_raw<std::int32_t>(raw, tensor.integers);
    case TensorProto::INT64:
      return append_raw<std::int64_t>(raw, tensor.integers);
    case TensorProto::BOOL:
      return append_raw<std::uint8_t>(raw, tensor.integers);
    case TensorProto::FLOAT16: {
      std::vector<std::uint16_t> halves;
      append_raw<std::uint16_t>(raw, halves);
      for (const std::uint16_t half : halves) tensor.floats.push_back(half_to_float(half));
      return;
    }
    default:
      broken(
          fmt::format("a constant has type {}; supported are float, float16, double, int32, "
                      "int64 and bool",
                      from.data_type()));
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

Tensor tensor_of(const TensorProto& from) {
  if (from.data_location() == TensorProto::EXTERNAL)
    broken(
        fmt::format("the constant '{}' is in another file, which is not supported", from.name()));
  Tensor tensor{.shape = {from.dims().begin(), from.dims().end()},
                .floats = {from.float_data().begin(), from.float_data().end()},
                .integers = {from.int64_data().begin(), from.int64_data().end()}};
  for (const double number : from.double_data())
    tensor.floats.push_back(static_cast<float>(number));
  append_raw(from, tensor);
  for (const std::int32_t word : from.int32_data()) {
    if (from.data_type() == TensorProto::FLOAT16)
      tensor.floats.push_back(half_to_float(static_cast<std::uint16_t>(word)));
    else
      tensor.integers.push_back(word);
  }
  check_size(tensor, from.name());
  return tensor;
}

Attribute attribute_of(const AttributeProto& from) {
  Attribute attribute{.kind = static_cast<Attribute::Kind>(from.type()),
                      .integer = from.i(),
                      .number = from.f(),
                      .text = from.s(),
                      .integers = {from.ints().begin(), from.ints().end()},
                      .numbers = {from.floats().begin(), from.floats().end()}};
  if (from.has_t()) attribute.tensor = tensor_of(from.t());
  if (attribute.kind == Attribute::kTensor && !from.has_t())
    broken(fmt::format("it is damaged (the attribute '{}' has no value)", from.name()));
  return attribute;
}

Node node_of(const NodeProto& from) {
  Node node{.op = from.op_type(),
            .inputs = {from.input().begin(), from.input().end()},
            .outputs = {from.output().begin(), from.output().end()}};
  for (const auto& attribute : from.attribute())
    node.attributes.emplace(attribute.name(), attribute_of(attribute));
  return node;
}

/// A free extent (one with a name, or with neither) is 0; that of the batch becomes 1.
Port port_of(const ValueInfoProto& from) {
  Port port{.name = from.name()};
  for (const auto& extent : from.type().tensor_type().shape().dim())
    port.shape.push_back(extent.dim_value());
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

Model model_of(const ModelProto& file) {
  Model model;
  for (const auto& opset : file.opset_import())
    if (opset.domain().empty() || opset.domain() == "ai.onnx") model.opset = opset.version();
  const GraphProto& graph = file.graph();
  for (const auto& node : graph.node()) add_node(model, node_of(node));
  for (const auto& constant : graph.initializer())
    add_constant(model, constant.name(), tensor_of(constant));
  for (const auto& input : graph.input()) model.inputs.push_back(port_of(input));
  for (const auto& output : graph.output()) model.outputs.push_back(port_of(output));
  // Before IR version 4, constants are listed among the inputs, too.
  std::erase_if(model.inputs,
                [&](const Port& port) { return model.constants.contains(port.name); });
  return model;
}

}  // namespace

Result<Model> parse_model(std::span<const std::uint8_t> bytes) try {
  ModelProto file;
  if (!file.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    broken("it is not an ONNX file, or damaged");
  if (!file.has_graph()) broken("it is not an ONNX file: it has no graph");
  Model model = model_of(file);
  if (auto sound = check_model(model); !sound) return tl::make_unexpected(sound.error());
  return model;
} catch (const Broken& error) {
  constexpr std::size_t kLongest = 400;  // it may name what the file names
  return fail(Errc::bad_config, shown_line(error.what, kLongest));
}

Result<Model> read_model(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostModel);
  if (!bytes) return fail_in("network", bytes.error());
  auto model = parse_model({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
  if (!model) return fail_in(fmt::format("network '{}'", file.string()), model.error());
  return model;
}

}  // namespace handcast::landmarks::onnx
