// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace handcast::landmarks::onednn {

AlignedBytes zeroed_bytes(std::size_t size) {
  AlignedBytes bytes(static_cast<std::byte*>(::operator new[](size, std::align_val_t{64})));
  std::memset(bytes.get(), 0, size);
  return bytes;
}

int Program::add_buffer(std::size_t bytes) {
  buffers_.push_back({.bytes = bytes});
  return static_cast<int>(buffers_.size()) - 1;
}

void Program::claim(std::size_t bytes) {
  if (bytes > kMostBytes - bytes_) throw TooLarge{};
  bytes_ += bytes;
}

int Program::add_fixed_buffer(std::size_t bytes) {
  claim(bytes);
  buffers_.push_back({.bytes = bytes, .fixed = zeroed_bytes(bytes)});
  return static_cast<int>(buffers_.size()) - 1;
}

void Program::drop(int buffer) {
  bytes_ -= buffers_[buffer].bytes;
  buffers_[buffer].fixed.reset();
}

void Program::reorder_now(const Value& from, const Value& to) {
  dnnl::memory source(from.desc, engine_, data(from.buffer)),
      target(to.desc, engine_, data(to.buffer));
  dnnl::reorder(source, target).execute(stream_, source, target);
  stream_.wait();
}

void Program::add_step(const dnnl::primitive& primitive, std::vector<Argument> arguments,
                       const dnnl::memory::desc& scratchpad) {
  if (scratchpad.get_size() > 0)
    arguments.push_back({DNNL_ARG_SCRATCHPAD, {scratchpad, add_buffer(scratchpad.get_size())}});
  steps_.push_back({.primitive = primitive, .arguments = std::move(arguments)});
}

void Program::note_lifetimes() {
  for (int i = 0; i < static_cast<int>(steps_.size()); ++i) {
    for (const Argument& argument : steps_[i].arguments) {
      Buffer& buffer = buffers_[argument.value.buffer];
      if (buffer.first < 0) buffer.first = i;
      buffer.last = i;
    }
  }
}

/// Places the largest buffers first, each at the lowest offset that no buffer in use at the same
/// time overlaps. Returns the size of the arena.
std::size_t Program::place_buffers() {
  std::vector<int> order(buffers_.size());
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int i) { return buffers_[i].fixed || buffers_[i].first < 0; });
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return buffers_[a].bytes > buffers_[b].bytes; });
  std::vector<const Buffer*> placed;  // by offset
  std::size_t whole = 0;
  for (const int i : order) {
    Buffer& buffer = buffers_[i];
    std::size_t offset = 0;
    for (const Buffer* other : placed) {
      if (other->last < buffer.first || other->first > buffer.last) continue;
      if (other->offset >= offset + buffer.bytes) break;
      offset = std::max(offset, (other->offset + other->bytes + 63) / 64 * 64);
    }
    buffer.offset = offset;
    whole = std::max(whole, offset + buffer.bytes);
    const auto by_offset = [](const Buffer* a, const Buffer* b) { return a->offset < b->offset; };
    placed.insert(std::upper_bound(placed.begin(), placed.end(), &buffer, by_offset), &buffer);
  }
  return whole;
}

void* Program::place(int buffer) const {
  const Buffer& it = buffers_[buffer];
  return it.fixed ? it.fixed.get() : arena_.get() + it.offset;
}

void Program::bind() {
  for (Step& step : steps_) {
    for (const Argument& argument : step.arguments)
      step.memories.emplace_back(argument.value.desc, engine_, place(argument.value.buffer));
    for (std::size_t i = 0; i < step.arguments.size(); ++i)
      step.bound.push_back({step.arguments[i].role, step.memories[i].get()});
  }
}

void Program::finish() {
  note_lifetimes();
  const std::size_t bytes = std::max<std::size_t>(place_buffers(), 64);
  claim(bytes);
  arena_ = zeroed_bytes(bytes);
  bind();
}

void Program::run() {
  for (const Step& step : steps_) {
    const auto status =
        dnnl_primitive_execute(step.primitive.get(), stream_.get(),
                               static_cast<int>(step.bound.size()), step.bound.data());
    dnnl::error::wrap_c_api(status, "a primitive did not run");
  }
  stream_.wait();
}

using dnnl::memory;

dnnl::primitive_attr own_scratchpad() {
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  return attributes;
}

void refuse(const Node& node, const std::string& why) {
  throw Refused{fmt::format("{} {}", node.title(), why)};
}

namespace {

void check_size(const Shape& shape) {
  if (onnx::elements(shape) == 0)
    throw Refused{fmt::format("a value of {} is empty or too large", onnx::to_string(shape))};
}

}  // namespace

memory::desc plain_desc(const Shape& shape) {
  check_size(shape);
  Shape strides(shape.size(), 1);
  for (std::size_t i = shape.size(); i-- > 1;) strides[i - 1] = strides[i] * shape[i];
  return {shape, memory::data_type::f32, strides};
}

memory::desc desc_like(const memory::desc& like, const Shape& shape) {
  const dnnl_blocking_desc_t& layout = like.data.format_desc.blocking;
  if (like.data.format_kind != dnnl_blocked || layout.inner_nblks > 0) return plain_desc(shape);
  check_size(shape);
  std::vector<std::size_t> order(shape.size());
  std::iota(order.rbegin(), order.rend(),
            std::size_t{0});  // of axes with equal strides, the last is the innermost
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return layout.strides[a] < layout.strides[b];
  });
  Shape strides(shape.size());
  std::int64_t stride = 1;
  for (const std::size_t axis : order) strides[axis] = std::exchange(stride, stride * shape[axis]);
  return {shape, memory::data_type::f32, strides};
}

memory::desc any_desc(const Shape& shape) {
  check_size(shape);
  return {shape, memory::data_type::f32, memory::format_tag::any};
}

Builder::Builder(const onnx::Model& model, const std::vector<Group>& groups) : model_(model) {
  const auto note = [&](const Node& node, int group) {
    for (const std::string& input : node.inputs) users_[input].push_back(group);
  };
  for (int i = 0; i < static_cast<int>(groups.size()); ++i) {
    note(groups[i].head, i);
    for (const Node& node : groups[i].tail) note(node, i);
  }
  for (const onnx::Port& port : model.outputs)
    users_[port.name].push_back(static_cast<int>(groups.size()));
}

Value Builder::operand(const Node& node, std::size_t input) {
  if (!node.has_input(input)) refuse(node, fmt::format("has no input {}", input));
  const std::string& name = node.inputs[input];
  if (const auto found = values_.find(name); found != values_.end()) return found->second;
  const onnx::Tensor* tensor = constant(node, input);
  if (!tensor || tensor->floats.empty())
    refuse(node, fmt::format("cannot use '{}', which is not a float tensor", name));
  const memory::desc desc = plain_desc(tensor->shape.empty() ? Shape{1} : tensor->shape);
  return values_[name] = weights(tensor->floats, desc, desc);
}

const Value& Builder::value(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) throw Refused{fmt::format("no node computes '{}'", name)};
  return found->second;
}

const onnx::Tensor* Builder::constant(const Node& node, std::size_t input) const {
  if (!node.has_input(input)) return nullptr;
  const auto found = model_.constants.find(node.inputs[input]);
  if (found == model_.constants.end())
    refuse(node, fmt::format("needs '{}' to be a constant", node.inputs[input]));
  return &found->second;
}

std::optional<std::vector<std::int64_t>> Builder::integers(const Node& node,
                                                           std::size_t input) const {
  const onnx::Tensor* tensor = constant(node, input);
  if (!tensor) return std::nullopt;
  if (!tensor->floats.empty())
    refuse(node, fmt::format("needs integers in '{}'", node.inputs[input]));
  return tensor->integers;
}

Value Builder::make(const memory::desc& desc) {
  return {desc, program_.add_buffer(desc.get_size())};
}

Value Builder::in_layout(const Value& value, const memory::desc& desc) {
  if (value.desc == desc) return value;
  const Value result = make(desc);
  const dnnl::reorder::primitive_desc reorder(engine(), value.desc, engine(), desc);
  program_.add_step(dnnl::reorder(reorder), {{DNNL_ARG_FROM, value}, {DNNL_ARG_TO, result}});
  return result;
}

/// Whether no value in the buffer is used after the present group, and at most once in it.
bool Builder::may_overwrite(int buffer) const {
  if (program_.is_fixed(buffer)) return false;
  int uses = 0;
  for (const auto& [name, value] : values_) {
    if (value.buffer != buffer) continue;
    const auto users = users_.find(name);
    if (users == users_.end()) continue;
    for (const int group : users->second) {
      if (group > now_) return false;
      if (group == now_) ++uses;
    }
  }
  return uses <= 1;
}

Value Builder::to_overwrite(const Value& value, const memory::desc& desc) {
  if (value.desc != desc) return in_layout(value, desc);
  if (may_overwrite(value.buffer)) return value;
  const Value copy = make(desc);
  const dnnl::reorder::primitive_desc reorder(engine(), desc, engine(), desc);
  program_.add_step(dnnl::reorder(reorder), {{DNNL_ARG_FROM, value}, {DNNL_ARG_TO, copy}});
  return copy;
}

Value Builder::weights(const std::vector<float>& numbers, const memory::desc& given,
                       const memory::desc& desc) {
  if (given.get_size() != numbers.size() * sizeof(float))
    throw Refused{"weights have another size than in the graph"};
  const Value result{desc, program_.add_fixed_buffer(desc.get_size())};
  const bool as_given = given == desc;
  const Value source =
      as_given ? result : Value{given, program_.add_fixed_buffer(given.get_size())};
  std::memcpy(program_.data(source.buffer), numbers.data(), given.get_size());
  if (!as_given) {
    program_.reorder_now(source, result);
    program_.drop(source.buffer);
  }
  return result;
}

}  // namespace handcast::landmarks::onednn
