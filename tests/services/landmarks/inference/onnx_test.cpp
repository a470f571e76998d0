// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tests/services/landmarks/inference/little_model.hpp"

namespace handcast::landmarks {
namespace {

using testing::HasSubstr;

TEST(OnnxReader, ReadsAFileAsItsBytesSay) {
  // ModelProto by hand: opset 11, y = Relu(x), x and y [1,2].
  const std::vector<std::uint8_t> bytes{
      0x42, 2,    0x10, 11,  // opset_import { version: 11 }
      0x3a, 52,              // graph
      0x0a, 12,   0x0a, 1,  'x', 0x12, 1,  'y',  0x22, 4, 'R', 'e',  'l', 'u',  // node
      0x5a, 17,   0x0a, 1,  'x', 0x12, 12, 0x0a, 10,   8, 1,   0x12, 6,   0x0a,
      0,    0x0a, 2,    8,  2,  // input: free batch, 2
      0x62, 17,   0x0a, 1,  'y', 0x12, 12, 0x0a, 10,   8, 1,   0x12, 6,   0x0a,
      0,    0x0a, 2,    8,  2,  // output
  };
  const auto model = onnx::parse_model(bytes);
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->opset, 11);
  ASSERT_EQ(model->nodes.size(), 1u);
  EXPECT_EQ(model->nodes[0].op, "Relu");
  EXPECT_EQ(model->nodes[0].inputs, std::vector<std::string>{"x"});
  EXPECT_EQ(model->inputs[0].name, "x");
  EXPECT_EQ(model->outputs[0].shape, (onnx::Shape{1, 2}));
}

TEST(OnnxReader, AModelSurvivesWritingAndReading) {
  const onnx::Model model = little_model();
  const auto again = onnx::parse_model(onnx::write_model(model));
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_EQ(again->nodes.size(), 2u);
  EXPECT_EQ(again->nodes[0].integers("pads", {}), (std::vector<std::int64_t>{1, 1, 1, 1}));
  EXPECT_EQ(again->constants.at("w").floats, model.constants.at("w").floats);
  EXPECT_EQ(again->constants.at("w").shape, (onnx::Shape{3, 2, 3, 3}));
  EXPECT_EQ(onnx::write_model(*again), onnx::write_model(model));
}

TEST(OnnxReader, AFileCutOffAnywhereIsAnErrorInASentence) {
  const std::vector<std::uint8_t> bytes = onnx::write_model(little_model());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto model = onnx::parse_model({bytes.data(), length});
    ASSERT_FALSE(model) << length;
    ASSERT_EQ(model.error().code, Errc::bad_config);
    ASSERT_FALSE(model.error().what.empty());
  }
}

/// The bytes of a field of a message in protobuf's wire format, shorter than 128.
std::string field(char number, const std::string& content) {
  return std::string{static_cast<char>(number << 3 | 2), static_cast<char>(content.size())} +
         content;
}

/// A file with one constant [16], its other fields as given.
Result<onnx::Model> with_constant(const std::string& fields) {
  const auto file = field(7, field(5, std::string("\x08\x10\x10\x01", 4) + field(8, "w") + fields));
  return onnx::parse_model({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
}

TEST(OnnxReader, AConstantOfBothWholeAndOtherNumbersIsRefused) {
  const auto model = with_constant(field(9, std::string(4, '\0')) + field(7, std::string(15, 1)));
  ASSERT_FALSE(model);
  EXPECT_THAT(model.error().what, HasSubstr("both integers and floats"));
}

TEST(OnnxReader, AConstantInAnotherFileIsRefused) {
  const auto model = with_constant(field(13, field(1, "location") + field(2, "w")) + "\x70\x01");
  ASSERT_FALSE(model);
  EXPECT_THAT(model.error().what, HasSubstr("in another file"));
}

/// Found by fuzzing: written again, it was no model.
TEST(OnnxReader, ATensorAttributeWithoutATensorIsRefused) {
  onnx::Model model = little_model();
  model.nodes[0].attributes["value"] = {.kind = onnx::Attribute::kTensor};
  model.nodes[0].attributes["value"].tensor = random_tensor({2}, 1);
  auto bytes = onnx::write_model(model);
  ASSERT_TRUE(onnx::parse_model(bytes));
  model.nodes[0].attributes["value"] = integer(3);
  bytes = onnx::write_model(model);
  const std::vector<std::uint8_t> kind{0xa0, 1, onnx::Attribute::kInteger};  // field 20
  const auto value = std::ranges::search(bytes, std::string_view("value"));
  const auto at = std::search(value.begin(), bytes.end(), kind.begin(), kind.end());
  ASSERT_NE(at, bytes.end());
  at[2] = onnx::Attribute::kTensor;
  EXPECT_THAT(onnx::parse_model(bytes).error().what,
              ::testing::HasSubstr("the attribute 'value' has no value"));
}

TEST(OnnxReader, FlippedBytesNeverCrashTheReaderOrTheNetwork) {
  const std::vector<std::uint8_t> bytes = onnx::write_model(little_model());
  unsigned random = 7;
  const auto next = [&] { return (random = random * 1664525u + 1013904223u) >> 8; };
  int opened = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> damaged = bytes;
    for (unsigned flips = 1 + next() % 4; flips > 0; --flips)
      damaged[next() % damaged.size()] = static_cast<std::uint8_t>(next());
    const auto model = onnx::parse_model(damaged);
    if (!model) continue;
    const auto network = open_network(ModelFile(damaged).path());
    opened += network.has_value();
    if (!network) {
      EXPECT_THAT(network.error().what, HasSubstr(".onnx'"));
    }
  }
  EXPECT_GT(opened, 0);  // a flip in a weight goes unnoticed: the fuzz reaches beyond the reader
}

void expect_refused(const onnx::Model& model, const std::string& sentence) {
  const ModelFile file(model);
  const auto network = open_network(file.path());
  ASSERT_FALSE(network);
  EXPECT_EQ(network.error().code, Errc::bad_config);
  EXPECT_THAT(network.error().what, HasSubstr(file.path().filename().string()));
  EXPECT_THAT(network.error().what, HasSubstr(sentence));
}

TEST(Networks, AWeightThatIsNotFiniteIsRefused) {
  onnx::Model model = little_model();
  model.constants["w"].floats[5] = NAN;
  expect_refused(model, "not finite");
}

TEST(Networks, ACycleIsRefused) {
  onnx::Model model = little_model();
  model.nodes[0].inputs[0] = "y";
  expect_refused(model, "nor computed by an earlier node");
}

TEST(Networks, AMissingWeightIsRefused) {
  onnx::Model model = little_model();
  model.constants.erase("w");
  expect_refused(model, "'w'");
}

TEST(Networks, AWeightWithTooFewNumbersIsRefused) {
  onnx::Model model = little_model();
  model.constants["w"].floats.pop_back();
  expect_refused(model, "declared as [3,2,3,3] and has 53 values");
}

TEST(Networks, ABatchOfTwoAndAFreeExtentAreRefused) {
  onnx::Model model = little_model();
  model.inputs[0].shape = {2, 2, 4, 4};
  expect_refused(model, "must be 1");
  model.inputs[0].shape = {1, 2, 0, 4};
  expect_refused(model, "must be fixed");
}

TEST(Networks, AnOutputOfAnotherShapeThanDeclaredIsRefused) {
  onnx::Model model = little_model();
  model.outputs[0].shape = {1, 3, 2, 2};
  expect_refused(model, "'y'");
}

TEST(Networks, AFileThatAsksForMoreMemoryThanAnyNetworkIsRefused) {
  onnx::Model model = little_model();
  model.constants["pads"] = {.shape = {8}, .integers = {0, 0, 0, 0, 0, 0, 1500, 1500}};
  for (int i = 0; i < 20; ++i) {
    const std::string name = "wide " + std::to_string(i);
    model.nodes.push_back({"Pad", {"c", "pads"}, {name}, {}});
    model.outputs.push_back({name, {1, 3, 1504, 1504}});
  }
  const auto network = open_network(ModelFile(model).path());
  ASSERT_FALSE(network);
  EXPECT_EQ(network.error().code, Errc::bad_config);
  EXPECT_THAT(network.error().what, HasSubstr("MB of memory"));
}

TEST(Networks, AnOutputThatNoNodeComputesIsNamed) {
  onnx::Model model = little_model();
  model.constants["k"] = random_tensor({1, 3}, 4);
  model.outputs.push_back({"k", {1, 3}});
  const auto network = open_network(ModelFile(model).path());
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().what, HasSubstr("no node computes 'k'"));
}

TEST(Networks, AnUnknownOperatorIsNamed) {
  onnx::Model model = little_model();
  model.nodes[1].op = "Fold";
  const auto network = open_network(ModelFile(model).path());
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().what, HasSubstr("operator Fold"));
}

TEST(Networks, AMissingFileAndGarbageAreNamed) {
  const ModelFile garbage(std::vector<std::uint8_t>{'n', 'o', ' ', 'm', 'o', 'd', 'e', 'l'});
  EXPECT_THAT(open_network("/no/such.onnx").error().what,
              HasSubstr("network: /no/such.onnx: cannot be read: No such file"));
  EXPECT_THAT(open_network(garbage.path()).error().what, HasSubstr("not an ONNX file"));
}

/// They would make each run twice as long.
TEST(Networks, NumbersTooSmallForANormalFloatCountAsNoneAndTheCallersArithmeticIsLeftAlone) {
  constexpr float kTooSmall = 1e-40f;
  onnx::Model model = little_model();
  model.constants["w"].floats.assign(model.constants["w"].floats.size(), 1e38f);
  model.constants["b"].floats.assign(3, 0.0f);
  const ModelFile file(model);
  const auto network = open_network(file.path());
  ASSERT_TRUE(network) << network.error().what;
  std::ranges::fill((*network)->input(0), kTooSmall);
  ASSERT_TRUE((*network)->run());
  EXPECT_THAT((*network)->output(0), testing::Each(0.0f));
  volatile float half = kTooSmall;
  half = half * 0.5f;
  EXPECT_GT(half, 0.0f);
}

TEST(Networks, AnInputThatIsNotFiniteIsAnErrorAndTheNextRunIsGood) {
  onnx::Model model = little_model();
  model.nodes.pop_back();
  model.outputs[0] = {"c", {1, 3, 4, 4}};
  const ModelFile file(model);
  const auto network = open_network(file.path());
  ASSERT_TRUE(network) << network.error().what;
  (*network)->input(0)[3] = NAN;
  const auto run = (*network)->run();
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, Errc::bad_data);
  (*network)->input(0)[3] = 0;
  EXPECT_TRUE((*network)->run());
}

}  // namespace
}  // namespace handcast::landmarks
