// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/inference/onnx/model.hpp"
#include "tests/services/landmarks/inference/write_onnx.hpp"

namespace handcast::landmarks {

/// Numbers in [-1, 1), the same in every run.
inline void fill(std::span<float> numbers, unsigned seed) {
  for (float& number : numbers) {
    seed = seed * 1664525u + 1013904223u;
    number = static_cast<float>(seed >> 8) / 8388608.f - 1;
  }
}

inline onnx::Tensor random_tensor(onnx::Shape shape, unsigned seed) {
  onnx::Tensor tensor{
      .shape = shape,
      .floats = std::vector<float>(static_cast<std::size_t>(onnx::elements(shape)))};
  fill(tensor.floats, seed);
  return tensor;
}

inline onnx::Attribute integers(std::vector<std::int64_t> values) {
  onnx::Attribute attribute{.kind = onnx::Attribute::kIntegers};
  attribute.integers = std::move(values);
  return attribute;
}

inline onnx::Attribute integer(std::int64_t value) {
  onnx::Attribute attribute{.kind = onnx::Attribute::kInteger};
  attribute.integer = value;
  return attribute;
}

inline onnx::Attribute text(std::string value) {
  onnx::Attribute attribute{.kind = onnx::Attribute::kText};
  attribute.text = std::move(value);
  return attribute;
}

/// [1,2,4,4] -> a convolution to 3 channels, bent at 0.
inline onnx::Model little_model() {
  onnx::Model model{.opset = 11};
  model.inputs = {{"x", {1, 2, 4, 4}}};
  model.outputs = {{"y", {1, 3, 4, 4}}};
  model.constants = {{"w", random_tensor({3, 2, 3, 3}, 1)}, {"b", random_tensor({3}, 2)}};
  model.nodes = {{"Conv",
                  {"x", "w", "b"},
                  {"c"},
                  {{"pads", integers({1, 1, 1, 1})}, {"kernel_shape", integers({3, 3})}}},
                 {"Relu", {"c"}, {"y"}, {}}};
  return model;
}

/// A file that goes with the object.
class ModelFile {
 public:
  explicit ModelFile(const std::vector<std::uint8_t>& bytes) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() / ("handcast-model-" + std::to_string(getpid()) +
                                                      "-" + std::to_string(count++) + ".onnx");
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  explicit ModelFile(const onnx::Model& model) : ModelFile(onnx::write_model(model)) {}
  ~ModelFile() { std::filesystem::remove(path_); }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace handcast::landmarks
