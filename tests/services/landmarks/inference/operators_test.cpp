// SPDX-License-Identifier: Apache-2.0
// A network of every kind of layer, against straightforward loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/settings/choice.hpp"
#include "tests/services/landmarks/inference/little_model.hpp"
#include "tests/services/landmarks/inference/opencv_network.hpp"

namespace handcast::landmarks {
namespace {

struct Image {
  int channels, rows, columns;
  std::vector<float> values =
      std::vector<float>(static_cast<std::size_t>(channels * rows * columns));

  float& at(int c, int y, int x) {
    return values[static_cast<std::size_t>((c * rows + y) * columns + x)];
  }
  float padded(int c, int y, int x) {
    return y < 0 || x < 0 || y >= rows || x >= columns ? 0 : at(c, y, x);
  }
};

Image convolved(Image in, const onnx::Tensor& weights, const onnx::Tensor& bias, int groups,
                int stride, int pad) {
  const int channels = static_cast<int>(weights.shape[0]), each = in.channels / groups,
            size = static_cast<int>(weights.shape[2]);
  Image out{channels, (in.rows + 2 * pad - size) / stride + 1,
            (in.columns + 2 * pad - size) / stride + 1};
  for (int c = 0; c < channels; ++c)
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < out.columns; ++x) {
        float sum = bias.floats[c];
        for (int i = 0; i < each; ++i)
          for (int v = 0; v < size; ++v)
            for (int u = 0; u < size; ++u)
              sum += weights.floats[((c * each + i) * size + v) * size + u] *
                     in.padded(c / (channels / groups) * each + i, y * stride + v - pad,
                               x * stride + u - pad);
        out.at(c, y, x) = sum;
      }
  return out;
}

Image max_of_four(Image in) {
  Image out{in.channels, in.rows / 2, in.columns / 2};
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < out.columns; ++x)
        out.at(c, y, x) = std::max({in.at(c, 2 * y, 2 * x), in.at(c, 2 * y, 2 * x + 1),
                                    in.at(c, 2 * y + 1, 2 * x), in.at(c, 2 * y + 1, 2 * x + 1)});
  return out;
}

/// Twice the size; linear: between the centres of pixels, the edge repeated.
Image doubled(Image in, bool linear) {
  Image out{in.channels, in.rows * 2, in.columns * 2};
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < out.columns; ++x) {
        const float v = (static_cast<float>(y) + 0.5f) / 2 - 0.5f,
                    u = (static_cast<float>(x) + 0.5f) / 2 - 0.5f;
        const int top = static_cast<int>(std::floor(v)), left = static_cast<int>(std::floor(u));
        const auto clamped = [&](int row, int column) {
          return in.at(c, std::clamp(row, 0, in.rows - 1), std::clamp(column, 0, in.columns - 1));
        };
        const float down = v - static_cast<float>(top), right = u - static_cast<float>(left);
        out.at(c, y, x) =
            !linear
                ? in.at(c, y / 2, x / 2)
                : (clamped(top, left) * (1 - right) + clamped(top, left + 1) * right) * (1 - down) +
                      (clamped(top + 1, left) * (1 - right) + clamped(top + 1, left + 1) * right) *
                          down;
      }
  return out;
}

/// A transposed convolution of kernel 2 and stride 2, each channel alone.
Image spread(Image in, const onnx::Tensor& weights) {
  Image out{in.channels, in.rows * 2, in.columns * 2};
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.rows; ++y)
      for (int x = 0; x < out.columns; ++x)
        out.at(c, y, x) = in.at(c, y / 2, x / 2) * weights.floats[c * 4 + y % 2 * 2 + x % 2];
  return out;
}

template <class Function>
Image each(Image a, Image b, Function&& function) {
  std::transform(a.values.begin(), a.values.end(), b.values.begin(), a.values.begin(), function);
  return a;
}

float relu(float value) { return std::max(value, 0.f); }

/// A mobile block with a residual, the ways to enlarge, and a head.
onnx::Model every_layer() {
  onnx::Model model{.opset = 13};
  model.inputs = {{"x", {1, 8, 8, 4}}};
  model.outputs = {{"maps", {1, 24, 8, 8}}, {"scores", {1, 5}}};
  model.constants = {{"w1", random_tensor({8, 4, 3, 3}, 1)},
                     {"b1", random_tensor({8}, 2)},
                     {"wd", random_tensor({8, 1, 3, 3}, 3)},
                     {"bd", random_tensor({8}, 4)},
                     {"wp", random_tensor({8, 8, 1, 1}, 5)},
                     {"bp", random_tensor({8}, 6)},
                     {"slope", random_tensor({8, 1, 1}, 7)},
                     {"wt", random_tensor({8, 1, 2, 2}, 8)},
                     {"wg", random_tensor({8, 5}, 9)},
                     {"bg", random_tensor({5}, 10)},
                     {"lo", {.floats = {-1}}},
                     {"hi", {.floats = {1}}},
                     {"scales", {.shape = {4}, .floats = {1, 1, 2, 2}}},
                     {"axes", {.shape = {2}, .integers = {2, 3}}}};
  const auto resize = [](const char* mode, const char* where, const char* rounding) {
    return std::map<std::string, onnx::Attribute>{{"mode", text(mode)},
                                                  {"coordinate_transformation_mode", text(where)},
                                                  {"nearest_mode", text(rounding)}};
  };
  model.nodes = {
      {"Transpose", {"x"}, {"planes"}, {{"perm", integers({0, 3, 1, 2})}}},
      {"Conv", {"planes", "w1", "b1"}, {"c1"}, {{"pads", integers({1, 1, 1, 1})}}},
      {"Clip", {"c1", "lo", "hi"}, {"r1"}, {}},
      {"Conv",
       {"r1", "wd", "bd"},
       {"d"},
       {{"group", integer(8)}, {"pads", integers({1, 1, 1, 1})}, {"strides", integers({2, 2})}}},
      {"Relu", {"d"}, {"rd"}, {}},
      {"Conv", {"rd", "wp", "bp"}, {"p"}, {}},
      {"MaxPool",
       {"r1"},
       {"pool"},
       {{"kernel_shape", integers({2, 2})}, {"strides", integers({2, 2})}}},
      {"Add", {"p", "pool"}, {"sum"}, {}},
      {"PRelu", {"sum", "slope"}, {"block"}, {}},
      {"Resize", {"block", "", "scales"}, {"near"}, resize("nearest", "asymmetric", "floor")},
      {"Resize", {"block", "", "scales"}, {"smooth"}, resize("linear", "half_pixel", "floor")},
      {"ConvTranspose",
       {"block", "wt"},
       {"up"},
       {{"group", integer(8)}, {"strides", integers({2, 2})}}},
      {"Concat", {"near", "smooth", "up"}, {"maps"}, {{"axis", integer(1)}}},
      {"GlobalAveragePool", {"block"}, {"mean"}, {}},
      {"Squeeze", {"mean", "axes"}, {"flat"}, {}},
      {"Gemm", {"flat", "wg", "bg"}, {"logits"}, {}},
      {"Sigmoid", {"logits"}, {"scores"}, {}},
  };
  for (onnx::Node& node : model.nodes) {
    if (node.op.starts_with("Conv") && node.op != "Concat") {
      const onnx::Shape shape = model.constants[node.inputs[1]].shape;
      node.attributes["kernel_shape"] = integers({shape[2], shape[3]});
    }
  }
  return model;
}

struct Expected {
  std::vector<float> maps, scores;
};

Expected by_loops(const onnx::Model& model, std::span<const float> input) {
  const auto& k = model.constants;
  Image planes{4, 8, 8};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 4; ++c)
        planes.at(c, y, x) = input[static_cast<std::size_t>((y * 8 + x) * 4 + c)];
  Image first = convolved(planes, k.at("w1"), k.at("b1"), 1, 1, 1);
  for (float& value : first.values) value = std::clamp(value, -1.f, 1.f);
  Image deep = convolved(first, k.at("wd"), k.at("bd"), 8, 2, 1);
  for (float& value : deep.values) value = relu(value);
  Image block =
      each(convolved(deep, k.at("wp"), k.at("bp"), 1, 1, 0), max_of_four(first), std::plus<>());
  for (std::size_t i = 0; i < block.values.size(); ++i)
    if (block.values[i] < 0) block.values[i] *= k.at("slope").floats[i / 16];
  Expected expected;
  for (const Image& part : {doubled(block, false), doubled(block, true), spread(block, k.at("wt"))})
    expected.maps.insert(expected.maps.end(), part.values.begin(), part.values.end());
  for (int o = 0; o < 5; ++o) {
    float sum = k.at("bg").floats[o];
    for (int c = 0; c < 8; ++c) {
      float mean = 0;
      for (int i = 0; i < 16; ++i) mean += block.values[static_cast<std::size_t>(c * 16 + i)] / 16;
      sum += mean * k.at("wg").floats[c * 5 + o];
    }
    expected.scores.push_back(1 / (1 + std::exp(-sum)));
  }
  return expected;
}

void expect_near(std::span<const float> actual, const std::vector<float>& expected,
                 const std::string& what) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    ASSERT_NEAR(actual[i], expected[i], 2e-5) << what << " at " << i;
}

using Open = Result<std::unique_ptr<Network>> (*)(const std::filesystem::path& file);

/// Of ours, and of the oracle.
class EveryNetwork : public testing::TestWithParam<std::pair<const char*, Open>> {
 protected:
  static auto open(const onnx::Model& model) { return GetParam().second(ModelFile(model).path()); }
};
INSTANTIATE_TEST_SUITE_P(, EveryNetwork,
                         testing::Values(
#ifdef HANDCAST_WITH_OPENCV_DNN
                             std::pair{"opencv", Open{open_opencv_network}},
#endif
                             std::pair{"ours", Open{open_network}}),
                         [](const auto& named) { return std::string(named.param.first); });

TEST_P(EveryNetwork, CalculatesWhatTheLoopsCalculate) {
  const onnx::Model model = every_layer();
  const auto network = open(model);
  ASSERT_TRUE(network) << network.error().what;
  for (unsigned seed = 20; seed < 25; ++seed) {
    fill((*network)->input(0), seed);
    ASSERT_TRUE((*network)->run());
    const Expected expected = by_loops(model, (*network)->input(0));
    expect_near((*network)->output(0), expected.maps, "maps");
    expect_near((*network)->output(1), expected.scores, "scores");
  }
}

TEST_P(EveryNetwork, LeavesItsInputAsItWasAndForgetsThePreviousRun) {
  const auto network = open(every_layer());
  ASSERT_TRUE(network) << network.error().what;
  Network& net = **network;
  const auto run_with = [&](unsigned seed) {
    fill(net.input(0), seed);
    EXPECT_TRUE(net.run());
    return std::vector<float>(net.output(0).begin(), net.output(0).end());
  };
  const std::vector<float> once = run_with(1);
  const std::vector<float> input(net.input(0).begin(), net.input(0).end());
  EXPECT_TRUE(net.run());
  EXPECT_TRUE(std::equal(input.begin(), input.end(), net.input(0).begin()));
  run_with(2);
  EXPECT_EQ(run_with(1), once);
}

/// y = c + conv(c): what is added is also what is convolved, so the sum must not be written over
/// it. z = relu(c), needed afterwards.
onnx::Model residual_model(bool needed_later) {
  onnx::Model model = little_model();
  model.constants = {{"w", random_tensor({16, 2, 3, 3}, 1)},
                     {"b", random_tensor({16}, 2)},
                     {"v", random_tensor({16, 16, 3, 3}, 3)}};
  onnx::Node first = model.nodes[0], second = model.nodes[0];
  second.inputs = {"c", "v", "b"};
  second.outputs = {"d"};
  model.nodes = {first, second, {"Add", {"d", "c"}, {"y"}, {}}};
  model.outputs = {{"y", {1, 16, 4, 4}}};
  if (needed_later) {
    // The convolution reads something else: only the later use forbids the overwriting.
    model.constants["u"] = model.constants["w"];
    model.nodes[1].inputs = {"x", "u", "b"};
    model.nodes.push_back({"Relu", {"c"}, {"z"}, {}});
    model.outputs.push_back({"z", {1, 16, 4, 4}});
  }
  return model;
}

TEST_P(EveryNetwork, ASumIsNotWrittenOverWhatIsStillConvolved) {
  const onnx::Model model = residual_model(false);
  const auto network = open(model);
  ASSERT_TRUE(network) << network.error().what;
  fill((*network)->input(0), 3);
  ASSERT_TRUE((*network)->run());
  const Image x{2, 4, 4, {(*network)->input(0).begin(), (*network)->input(0).end()}};
  const Image c = convolved(x, model.constants.at("w"), model.constants.at("b"), 1, 1, 1);
  const Image y = each(convolved(c, model.constants.at("v"), model.constants.at("b"), 1, 1, 1), c,
                       std::plus<>());
  expect_near((*network)->output(0), y.values, "residual");
}

TEST_P(EveryNetwork, ASumIsNotWrittenOverWhatIsNeededLater) {
  const onnx::Model model = residual_model(true);
  const auto network = open(model);
  ASSERT_TRUE(network) << network.error().what;
  fill((*network)->input(0), 3);
  ASSERT_TRUE((*network)->run());
  const Image x{2, 4, 4, {(*network)->input(0).begin(), (*network)->input(0).end()}};
  Image c = convolved(x, model.constants.at("w"), model.constants.at("b"), 1, 1, 1);
  expect_near((*network)->output(0), each(c, c, std::plus<>()).values, "sum");
  for (float& value : c.values) value = relu(value);
  expect_near((*network)->output(1), c.values, "what is needed later");
}

/// y = pad(c) + d(pad(c)): a row above, two columns to the right, four channels more.
onnx::Model padded_model() {
  onnx::Model model = little_model();
  model.constants = {{"w", random_tensor({16, 2, 3, 3}, 1)},
                     {"b", random_tensor({16}, 2)},
                     {"v", random_tensor({20, 20, 1, 1}, 3)},
                     {"a", random_tensor({20}, 4)},
                     {"pads", {.shape = {8}, .integers = {0, 0, 1, 0, 0, 4, 0, 2}}}};
  model.nodes = {model.nodes[0],
                 {"Pad", {"c", "pads"}, {"p"}, {}},
                 {"Conv", {"p", "v", "a"}, {"d"}, {{"kernel_shape", integers({1, 1})}}},
                 {"Add", {"d", "p"}, {"y"}, {}}};
  model.outputs = {{"y", {1, 20, 5, 6}}};
  return model;
}

TEST_P(EveryNetwork, PadsWithZerosEveryTime) {
  const onnx::Model model = padded_model();
  const auto network = open(model);
  ASSERT_TRUE(network) << network.error().what;
  for (unsigned seed = 3; seed < 6; ++seed) {
    fill((*network)->input(0), seed);
    ASSERT_TRUE((*network)->run());
    Image c = convolved({2, 4, 4, {(*network)->input(0).begin(), (*network)->input(0).end()}},
                        model.constants.at("w"), model.constants.at("b"), 1, 1, 1);
    Image p{20, 5, 6};
    for (int channel = 0; channel < 16; ++channel)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) p.at(channel, y + 1, x) = c.at(channel, y, x);
    const Image d = convolved(p, model.constants.at("v"), model.constants.at("a"), 1, 1, 0);
    expect_near((*network)->output(0), each(d, p, std::plus<>()).values, "padded");
  }
}

}  // namespace
}  // namespace handcast::landmarks
