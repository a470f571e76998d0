// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onnx/model.hpp"
#include "services/landmarks/inference/onnx/wire.hpp"

namespace handcast::landmarks::onnx {

namespace {

constexpr int kFloat = 1, kInt64 = 7;  // TensorProto.DataType

template <class T>
Bytes bytes_of(const std::vector<T>& numbers) {
  return {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * sizeof(T)};
}

WireWriter tensor_message(const std::string& name, const Tensor& tensor) {
  WireWriter message;
  for (const std::int64_t extent : tensor.shape)
    message.varint(1, static_cast<std::uint64_t>(extent));
  message.varint(2, tensor.integers.empty() ? kFloat : kInt64);
  message.text(8, name);
  message.bytes(9, tensor.integers.empty() ? bytes_of(tensor.floats) : bytes_of(tensor.integers));
  return message;
}

WireWriter attribute_message(const std::string& name, const Attribute& attribute) {
  WireWriter message;
  message.text(1, name);
  switch (attribute.kind) {
    case Attribute::kNumber:
      message.number32(2, attribute.number);
      break;
    case Attribute::kInteger:
      message.varint(3, static_cast<std::uint64_t>(attribute.integer));
      break;
    case Attribute::kText:
      message.text(4, attribute.text);
      break;
    case Attribute::kTensor:
      message.message(5, tensor_message("", attribute.tensor));
      break;
    case Attribute::kNumbers:
      for (const float number : attribute.numbers) message.number32(7, number);
      break;
    case Attribute::kIntegers:
      for (const std::int64_t integer : attribute.integers)
        message.varint(8, static_cast<std::uint64_t>(integer));
      break;
  }
  message.varint(20, attribute.kind);
  return message;
}

WireWriter node_message(const Node& node) {
  WireWriter message;
  for (const std::string& input : node.inputs) message.text(1, input);
  for (const std::string& output : node.outputs) message.text(2, output);
  message.text(4, node.op);
  for (const auto& [name, attribute] : node.attributes)
    message.message(5, attribute_message(name, attribute));
  return message;
}

WireWriter port_message(const Port& port) {
  WireWriter shape, tensor, type, message;
  for (const std::int64_t extent : port.shape) {
    WireWriter dimension;
    dimension.varint(1, static_cast<std::uint64_t>(extent));
    shape.message(1, dimension);
  }
  tensor.varint(1, kFloat);
  tensor.message(2, shape);
  type.message(1, tensor);
  message.text(1, port.name);
  message.message(2, type);
  return message;
}

}  // namespace

std::vector<std::uint8_t> write_model(const Model& model) {
  WireWriter graph, opset, file;
  for (const Node& node : model.nodes) graph.message(1, node_message(node));
  graph.text(2, "handcast");
  for (const auto& [name, tensor] : model.constants) graph.message(5, tensor_message(name, tensor));
  for (const Port& port : model.inputs) graph.message(11, port_message(port));
  for (const Port& port : model.outputs) graph.message(12, port_message(port));
  opset.text(1, "");
  opset.varint(2, static_cast<std::uint64_t>(model.opset));
  file.varint(1, 7);  // IR version of the operator sets 13 and up
  file.message(7, graph);
  file.message(8, opset);
  return std::move(file).take();
}

}  // namespace handcast::landmarks::onnx
