// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onednn/program.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

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

}  // namespace handcast::landmarks::onednn
