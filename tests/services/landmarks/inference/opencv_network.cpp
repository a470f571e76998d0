// SPDX-License-Identifier: Apache-2.0
#include "tests/services/landmarks/inference/opencv_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "tests/services/landmarks/inference/write_onnx.hpp"

namespace handcast::landmarks {

namespace {

std::vector<Network::Port> ports_of(const std::vector<onnx::Port>& ports) {
  std::vector<Network::Port> result;
  result.reserve(ports.size());
  for (const onnx::Port& port : ports)
    result.push_back({port.name, {port.shape.begin(), port.shape.end()}});
  return result;
}

/// OpenCV names a layer after its output, with a prefix that depends on OpenCV's version.
std::string layer_of(const std::vector<std::string>& layers, const std::string& output) {
  const auto ends_with_it = [&](const std::string& layer) {
    return layer == output || layer.ends_with("!" + output);
  };
  const auto found = std::find_if(layers.begin(), layers.end(), ends_with_it);
  return found == layers.end() ? std::string() : *found;
}

/// cv::setNumThreads applies to the whole process.
class OpencvNetwork final : public Network {
 public:
  explicit OpencvNetwork(const onnx::Model& model)
      : inputs_(ports_of(model.inputs)), outputs_(ports_of(model.outputs)) {
    for (const Port& port : inputs_) blobs_.emplace_back(port.shape, CV_32F, cv::Scalar(0));
  }

  Result<void> load(const std::vector<std::uint8_t>& file) try {
    cv::setNumThreads(1);
    cv::utils::logging::setLogLevel(
        cv::utils::logging::LOG_LEVEL_SILENT);  // the exception has the same text
    net_ = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(file.data()), file.size());
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    const std::vector<std::string> layers = net_.getLayerNames();
    for (const Port& port : outputs_) {
      layers_.push_back(layer_of(layers, port.name));
      if (layers_.back().empty())
        return fail(Errc::bad_config, fmt::format("OpenCV has no output '{}'", port.name));
    }
    return run();
  } catch (const std::exception& error) {
    return fail(Errc::bad_config,
                fmt::format("OpenCV cannot run it: {}", first_line(error.what())));
  }

  std::span<const Port> inputs() const override { return inputs_; }
  std::span<const Port> outputs() const override { return outputs_; }
  std::span<float> input(std::size_t i) override {
    return {blobs_[i].ptr<float>(), inputs_[i].size()};
  }
  std::span<const float> output(std::size_t i) const override {
    return {results_[i].ptr<float>(), outputs_[i].size()};
  }

  Result<void> run() override try {
    for (std::size_t i = 0; i < inputs_.size(); ++i) net_.setInput(blobs_[i], inputs_[i].name);
    net_.forward(results_, layers_);
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      if (auto sound = check_output(i); !sound) return sound;
    return {};
  } catch (const std::exception& error) {
    return fail(Errc::bad_data, fmt::format("OpenCV: {}", first_line(error.what())));
  }

 private:
  /// The text of an exception without its second line, a place in OpenCV's source.
  static std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

  Result<void> check_output(std::size_t i) {
    const std::size_t size = outputs_[i].size();
    if (results_[i].total() != size || results_[i].type() != CV_32F)
      return fail(Errc::bad_config, fmt::format("OpenCV computes {} values of '{}', not {}",
                                                results_[i].total(), outputs_[i].name, size));
    const std::span<const float> values = output(i);
    if (!std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value); }))
      return fail(Errc::bad_data,
                  fmt::format("the network's output '{}' is not finite", outputs_[i].name));
    return {};
  }

  std::vector<Port> inputs_, outputs_;
  std::vector<cv::Mat> blobs_, results_;
  std::vector<std::string> layers_;  ///< of the outputs, in OpenCV's names
  cv::dnn::Net net_;
};

}  // namespace

Result<std::unique_ptr<Network>> open_opencv_network(const std::filesystem::path& file) {
  auto model = onnx::read_model(file);
  if (!model) return tl::make_unexpected(model.error());
  onnx::adapt_for_opencv(*model);
  auto network = std::make_unique<OpencvNetwork>(*model);
  if (auto loaded = network->load(onnx::write_model(*model)); !loaded)
    return fail(Errc::bad_config,
                fmt::format("network '{}': {}", file.string(), loaded.error().what));
  return network;
}

}  // namespace handcast::landmarks
