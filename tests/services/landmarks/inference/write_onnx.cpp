// SPDX-License-Identifier: Apache-2.0
#include "tests/services/landmarks/inference/write_onnx.hpp"

#define ONNX_ML 1  // the only kind that is installed
#include <onnx/onnx_pb.h>

namespace handcast::landmarks::onnx {

namespace {

using ::onnx::AttributeProto, ::onnx::ModelProto, ::onnx::NodeProto, ::onnx::TensorProto,
    ::onnx::ValueInfoProto;

void write(const Tensor& tensor, TensorProto& to) {
  to.mutable_dims()->Add(tensor.shape.begin(), tensor.shape.end());
  const bool is_float = tensor.integers.empty();
  to.set_data_type(is_float ? TensorProto::FLOAT : TensorProto::INT64);
  if (is_float)
    to.set_raw_data(tensor.floats.data(), tensor.floats.size() * sizeof(float));
  else
    to.set_raw_data(tensor.integers.data(), tensor.integers.size() * sizeof(std::int64_t));
}

void write(const Attribute& attribute, AttributeProto& to) {
  to.set_type(static_cast<AttributeProto::AttributeType>(attribute.kind));
  switch (attribute.kind) {
    case Attribute::kNumber:
      return to.set_f(attribute.number);
    case Attribute::kInteger:
      return to.set_i(attribute.integer);
    case Attribute::kText:
      return to.set_s(attribute.text);
    case Attribute::kTensor:
      return write(attribute.tensor, *to.mutable_t());
    case Attribute::kNumbers:
      return to.mutable_floats()->Add(attribute.numbers.begin(), attribute.numbers.end());
    case Attribute::kIntegers:
      return to.mutable_ints()->Add(attribute.integers.begin(), attribute.integers.end());
  }
}

void write(const Node& node, NodeProto& to) {
  to.mutable_input()->Add(node.inputs.begin(), node.inputs.end());
  to.mutable_output()->Add(node.outputs.begin(), node.outputs.end());
  to.set_op_type(node.op);
  for (const auto& [name, attribute] : node.attributes) {
    auto& named = *to.add_attribute();
    named.set_name(name);
    write(attribute, named);
  }
}

void write(const Port& port, ValueInfoProto& to) {
  to.set_name(port.name);
  auto& type = *to.mutable_type()->mutable_tensor_type();
  type.set_elem_type(TensorProto::FLOAT);
  for (const std::int64_t extent : port.shape)
    type.mutable_shape()->add_dim()->set_dim_value(extent);
}

}  // namespace

std::vector<std::uint8_t> write_model(const Model& model) {
  ModelProto file;
  file.set_ir_version(7);  // of the operator sets 13 and up
  auto& opset = *file.add_opset_import();
  opset.set_domain("");
  opset.set_version(model.opset);
  auto& graph = *file.mutable_graph();
  graph.set_name("handcast");
  for (const Node& node : model.nodes) write(node, *graph.add_node());
  for (const auto& [name, tensor] : model.constants) {
    auto& named = *graph.add_initializer();
    named.set_name(name);
    write(tensor, named);
  }
  for (const Port& port : model.inputs) write(port, *graph.add_input());
  for (const Port& port : model.outputs) write(port, *graph.add_output());
  const std::string bytes = file.SerializeAsString();
  return {bytes.begin(), bytes.end()};
}

}  // namespace handcast::landmarks::onnx
