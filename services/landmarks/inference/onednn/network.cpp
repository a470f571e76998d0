// SPDX-License-Identifier: Apache-2.0
// Runs a graph with oneDNN's primitives. Shapes, layouts and the order of
// the weights are determined once, when the network is opened.
#include "services/landmarks/inference/network.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "ipc/base/quote.hpp"
#include "services/landmarks/inference/cost.hpp"
#include "services/landmarks/inference/onednn/fuse.hpp"
#include "services/landmarks/inference/onednn/operators.hpp"

namespace handcast::landmarks {

namespace {

/// While it exists, OpenMP uses one thread for the calling thread. (Debian's oneDNN runs on
/// OpenMP.)
class OneThread {
 public:
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_ = omp_get_max_threads();
};

/// While it exists, denormal floats count as 0. An operation on one takes a hundred times as long.
class NoDenormals {
 public:
#if defined(__x86_64__)
  NoDenormals() { _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero); }
  ~NoDenormals() { _mm_setcsr(before_); }
  NoDenormals(const NoDenormals&) = delete;
  NoDenormals& operator=(const NoDenormals&) = delete;

 private:
  static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
  unsigned before_ = _mm_getcsr();
#endif
};

class OnednnNetwork final : public Network {
 public:
  explicit OnednnNetwork(const onnx::Model& model) {
    const std::vector<onednn::Group> groups = onednn::fuse(model);
    onednn::Builder builder(model, groups);
    for (const onnx::Port& port : model.inputs) add_input(builder, port);
    for (int i = 0; i < static_cast<int>(groups.size()); ++i) {
      builder.begin(i);
      emit_group(builder, groups[i]);
    }
    for (const onnx::Port& port : model.outputs) add_output(builder, port);
    mmac_ = builder.multiplications() / 1e6;
    program_ = std::move(builder.program());
    program_.finish();
  }

  std::span<const Port> inputs() const override { return inputs_; }
  std::span<const Port> outputs() const override { return outputs_; }
  std::span<float> input(std::size_t i) override { return {input_data_[i], inputs_[i].size()}; }
  std::span<const float> output(std::size_t i) const override {
    return {output_data_[i], outputs_[i].size()};
  }

  double mmac() const { return mmac_; }

  Result<void> run() override try {
    const OneThread one_thread;
    const NoDenormals no_denormals;
    program_.run();
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      const std::span<const float> values = output(i);
      if (!std::all_of(values.begin(), values.end(),
                       [](float value) { return std::isfinite(value); }))
        return fail(Errc::bad_data,
                    fmt::format("the network's output '{}' is not finite", outputs_[i].name));
    }
    return {};
  } catch (const dnnl::error& error) {
    return fail(Errc::bad_data, fmt::format("oneDNN: {}", error.what()));
  }

 private:
  static float* fixed_value(onednn::Builder& builder, const std::string& name,
                            const onnx::Shape& shape) {
    const auto desc = onednn::plain_desc(shape);
    const onednn::Value value{desc, builder.program().add_fixed_buffer(desc.get_size())};
    builder.define(name, value);
    return static_cast<float*>(builder.program().data(value.buffer));
  }

  void add_input(onednn::Builder& builder, const onnx::Port& port) {
    inputs_.push_back({port.name, {port.shape.begin(), port.shape.end()}});
    input_data_.push_back(fixed_value(builder, port.name, port.shape));
  }

  static void emit_group(onednn::Builder& builder, const onednn::Group& group) {
    std::span<const onnx::Node> tail = group.tail;
    tail = tail.subspan(onednn::emit(builder, group.head, tail));
    while (!tail.empty()) tail = tail.subspan(1 + onednn::emit(builder, tail[0], tail.subspan(1)));
  }

  void add_output(onednn::Builder& builder, const onnx::Port& port) {
    const onednn::Value made = builder.value(port.name);
    if (made.desc.dims() != port.shape)
      throw onednn::Refused{fmt::format("its output '{}' is {}, declared as {}", port.name,
                                        onnx::to_string(made.desc.dims()),
                                        onnx::to_string(port.shape))};
    outputs_.push_back({port.name, {port.shape.begin(), port.shape.end()}});
    output_data_.push_back(fixed_value(builder, port.name, port.shape));
    const onednn::Value place = builder.value(port.name);
    const dnnl::reorder::primitive_desc copy(builder.engine(), made.desc, builder.engine(),
                                             place.desc);
    builder.program().add_step(dnnl::reorder(copy), {{DNNL_ARG_FROM, made}, {DNNL_ARG_TO, place}});
  }

  onednn::Program program_;
  double mmac_ = 0;
  std::vector<Port> inputs_, outputs_;
  std::vector<float*> input_data_;
  std::vector<const float*> output_data_;
};

Result<std::unique_ptr<OnednnNetwork>> open(const std::filesystem::path& file) {
  const std::string place = fmt::format("network '{}'", file.string());
  const auto model = onnx::read_model(file);
  if (!model) return tl::make_unexpected(model.error());
  try {
    const OneThread one_thread;
    auto network = std::make_unique<OnednnNetwork>(*model);
    if (auto warm = network->run(); !warm)
      return fail(Errc::bad_config, place + ": " + warm.error().what);
    return network;
  } catch (const onednn::Refused& refused) {
    return fail(Errc::bad_config, place + ": " + shown_line(refused.what, 400));
  } catch (const onednn::Program::TooLarge&) {
    return fail(Errc::bad_config, fmt::format("{}: it needs more than {} MB of memory", place,
                                              onednn::Program::kMostBytes >> 20));
  } catch (const std::exception& error) {
    return fail(Errc::bad_config, fmt::format("{}: oneDNN cannot run it: {}", place, error.what()));
  }
}

}  // namespace

Result<std::unique_ptr<Network>> open_network(const std::filesystem::path& file) {
  return open(file).map(
      [](std::unique_ptr<OnednnNetwork> network) -> std::unique_ptr<Network> { return network; });
}

Result<double> network_mmac(const std::filesystem::path& file) {
  return open(file).map(
      [](const std::unique_ptr<OnednnNetwork>& network) { return network->mmac(); });
}

}  // namespace handcast::landmarks
