// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "services/lab/hand_maker/glb_write.hpp"
#include "tests/services/lab/hand_maker/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

using namespace samples;
using nlohmann::json;
using ::testing::HasSubstr;

class HandFile : public ::testing::Test {
 protected:
  HandFile()
      : folder_(std::filesystem::temp_directory_path() /
                ("handcast-hand-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~HandFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  std::filesystem::path saved() const {
    const auto file = path("hand.glb");
    EXPECT_TRUE(save_hand(mean_hand(Side::left), file));
    return file;
  }

  /// The saved hand with its JSON changed.
  std::filesystem::path changed(const std::function<void(json&)>& change) const {
    return changed_of(saved(), change);
  }
  std::filesystem::path changed_of(const std::filesystem::path& file,
                                   const std::function<void(json&)>& change) const {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    std::uint32_t length;
    std::memcpy(&length, bytes.data() + 12, 4);
    json gltf = json::parse(bytes.substr(20, length));
    const std::string binary = bytes.substr(20 + length + 8);
    change(gltf);
    std::string text = gltf.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::ofstream out(path("changed.glb"), std::ios::binary);
    const auto put = [&](std::size_t value) {
      const auto word = static_cast<std::uint32_t>(value);
      out.write(reinterpret_cast<const char*>(&word), 4);
    };
    out << "glTF";
    for (const std::size_t word : {std::size_t{2}, 28 + text.size() + binary.size(), text.size()})
      put(word);
    out << "JSON" << text;
    put(binary.size());
    out << std::string("BIN\0", 4) << binary;
    return path("changed.glb");
  }

  static std::string refusal(const std::filesystem::path& file) {
    const auto hand = load_hand(file, Side::left);
    if (hand) return "(it was read)";
    EXPECT_EQ(hand.error().code, Errc::bad_config);
    EXPECT_THAT(hand.error().what, HasSubstr(file.filename().string()));
    return hand.error().what;
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(HandFile, ComesBackAsItWasSaved) {
  const HandMesh& hand = mean_hand(Side::left);
  const auto read = load_hand(saved(), Side::left);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->positions, hand.positions);
  EXPECT_EQ(read->normals, hand.normals);
  EXPECT_EQ(read->uv, hand.uv);
  EXPECT_EQ(read->joints, hand.joints);
  EXPECT_EQ(read->triangles, hand.triangles);
  EXPECT_EQ(read->chart, hand.chart);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    for (int k = 0; k < 4; ++k) ASSERT_NEAR(read->weights[v][k], hand.weights[v][k], 1e-6);
  // A file has the inverse of a frame. A scale that is rounding changes nothing in it.
  for (int j = 0; j < kJoints; ++j)
    EXPECT_EQ(read->rest[j], glm::inverse(glm::inverse(hand.rest[j]))) << kJointNames[j];
}

TEST_F(HandFile, ARefitWorksOnALoadedHand) {
  const auto read = load_hand(saved(), Side::left);
  ASSERT_TRUE(read);
  const HandMesh direct = refit_hand(mean_hand(Side::left), another_person()),
                 loaded = refit_hand(*read, another_person());
  for (std::size_t v = 0; v < direct.vertex_count(); ++v)
    ASSERT_LT(glm::distance(direct.positions[v], loaded.positions[v]), 2e-5f);
}

TEST_F(HandFile, HandsMadeByTheBuildAreFound) {
  for (const Side side : {Side::left, Side::right}) {
    const auto hand = load_hand_or_default({}, side);
    ASSERT_TRUE(hand) << hand.error().what;
    EXPECT_EQ(hand->side, side);
    const float thumb_side = side == Side::left ? 1.0f : -1.0f;
    EXPECT_GT(hand->rest[5][3].x * thumb_side, 0.05f);
  }
}

TEST_F(HandFile, AssetsFolderOfTheEnvironmentComesFirst) {
  setenv("HANDCAST_ASSETS", "/somewhere", 1);
  EXPECT_EQ(default_hand_file(Side::right), "/somewhere/hand_right.glb");
  unsetenv("HANDCAST_ASSETS");
  EXPECT_NE(default_hand_file(Side::right).string().find("share/handcast/hand_right.glb"),
            std::string::npos);
}

TEST_F(HandFile, NamesMayCarryASideAndUnderscores) {
  const auto file = changed([](json& gltf) {
    for (json& node : gltf["nodes"]) {
      std::string name = "Left_" + node["name"].get<std::string>();
      std::replace(name.begin(), name.end(), '-', '_');
      node["name"] = name;
    }
  });
  const auto read = load_hand(file, Side::left);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->joints, mean_hand(Side::left).joints);
}

TEST_F(HandFile, AMissingMetacarpalIsTakenFromItsParent) {
  const auto file = changed([](json& gltf) { gltf["nodes"][21]["name"] = "bone"; });
  const auto read = load_hand(file, Side::left);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->rest[21], read->rest[1]);
}

TEST_F(HandFile, MissingJointsAreNamed) {
  const auto file =
      changed([](json& gltf) { gltf["nodes"][8]["name"] = gltf["nodes"][3]["name"] = "bone"; });
  EXPECT_THAT(refusal(file),
              HasSubstr("thumb-phalanx-proximal, index-finger-phalanx-intermediate"));
}

TEST_F(HandFile, AFileThatIsNotThereIsSaid) {
  EXPECT_THAT(refusal(path("nothing.glb")), HasSubstr("No such file"));
}

TEST_F(HandFile, AFileThatIsNoGltfIsSaid) {
  for (const std::string content : {"", "plain text", "glTF\2\0\0\0 cut off"}) {
    std::ofstream(path("odd.glb"), std::ios::binary) << content;
    EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("not a valid glTF file"));
  }
}

TEST_F(HandFile, JsonThatIsNestedTooDeeplyIsRefused) {
  const std::string deep(100'000, '[');
  std::ofstream(path("deep.gltf")) << R"({"asset": {"version": "2.0"}, "extras": )" << deep;
  EXPECT_THAT(refusal(path("deep.gltf")), HasSubstr("nested more than 64 deep"));
}

TEST_F(HandFile, AMeshThatIsNotInMetresIsRefused) {
  for (const float scale : {100.0f, 0.001f, 1e37f}) {
    HandMesh hand = mean_hand(Side::left);
    for (auto& position : hand.positions) position *= scale;
    for (auto& joint : hand.rest) joint[3] *= glm::vec4(glm::vec3(std::min(scale, 1e3f)), 1);
    ASSERT_TRUE(save_hand(hand, path("odd.glb")));
    EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("from the wrist; a hand in metres")) << scale;
  }
}

TEST_F(HandFile, JointsInOnePlaceAreRefused) {
  HandMesh hand = mean_hand(Side::left);
  constexpr int kIndexIntermediate = 8;
  hand.rest[kIndexIntermediate][3] = hand.rest[kIndexIntermediate - 1][3];
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(
      refusal(path("odd.glb")),
      HasSubstr("index-finger-phalanx-proximal and index-finger-phalanx-intermediate lie in one"));
  hand = mean_hand(Side::left);
  hand.rest[kIndexIntermediate - 1][3] = hand.rest[kIndexIntermediate - 2][3];
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")),
              HasSubstr("index-finger-metacarpal and index-finger-phalanx-proximal lie in one"));
}

TEST_F(HandFile, VerticesWithoutAJointAreRefused) {
  HandMesh hand = mean_hand(Side::left);
  for (auto& weight : hand.weights) weight = {};
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("vertices are not bound to a joint"));
}

TEST_F(HandFile, TrianglesThatWouldTakeForeverToDrawAreRefused) {
  HandMesh hand = mean_hand(Side::left);
  std::array<std::uint16_t, 3> large{};
  for (std::uint16_t k = 0; k < 3; ++k) {
    large[k] = k;
    hand.positions[k] = glm::vec3(k == 0 ? 0.3f : 0, k == 1 ? 0.3f : 0, k == 2 ? 0.3f : 0);
  }
  hand.triangles.resize(60'000, large);
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("m2 are possible"));
  hand.positions[2] = hand.positions[1];
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("triangles have edges of"));
}

TEST_F(HandFile, TextureCoordinatesThatWouldTakeForeverToPaintAreRefused) {
  HandMesh hand = mean_hand(Side::left);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    hand.uv[v] = {v % 2 == 0 ? 0.f : 1.f, v % 3 == 0 ? 0.f : 1.f};
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("texture coordinates cover the texture"));
  hand = mean_hand(Side::left);
  hand.uv[5].y = 2.3e38f;
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("texture coordinates contain ("));
}

TEST_F(HandFile, MoreTrianglesThanSixteenBitsNumberAreRefused) {
  HandMesh hand = mean_hand(Side::left);
  hand.triangles.resize(65'535, hand.triangles.front());
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("too many"));
}

TEST_F(HandFile, ABufferThatIsAPipeIsNotWaitedFor) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::ofstream(path("odd.gltf"))
      << R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "pipe", "byteLength": 4}]})";
  EXPECT_THAT(refusal(path("odd.gltf")), HasSubstr("not a valid glTF file"));
}

TEST_F(HandFile, OneVertexFarAwayIsRefused) {
  HandMesh hand = mean_hand(Side::left);
  hand.positions[7].x = -7.7e36f;
  ASSERT_TRUE(save_hand(hand, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("from the wrist"));
}

TEST_F(HandFile, AMeshWithoutSkinIsSaid) {
  const auto file = changed([](json& gltf) {
    gltf.erase("skins");
    gltf["nodes"][26].erase("skin");
  });
  EXPECT_THAT(refusal(file), HasSubstr("no skinned mesh"));
}

TEST_F(HandFile, AJointThatIsBoundByNoTurnAndShiftIsNamed) {
  constexpr int kThumbTip = 5;
  for (const float scale : {0.01f, 1.5f, -1.0f}) {
    HandMesh hand = mean_hand(Side::left);
    hand.rest[kThumbTip] = hand.rest[kThumbTip] * glm::mat4(glm::mat3(scale));
    ASSERT_TRUE(save_hand(hand, path("odd.glb")));
    EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("joint thumb-tip")) << scale;
  }
}

TEST_F(HandFile, AnIndexBeyondTheVerticesIsSaid) {
  const auto file = changed([](json& gltf) {
    for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"})
      gltf["accessors"][gltf["meshes"][0]["primitives"][0]["attributes"][attribute].get<int>()]
          ["count"] = 100;
  });
  EXPECT_THAT(refusal(file), HasSubstr("a triangle refers to vertex"));
}

TEST_F(HandFile, ANegativeIndexIsSaid) {
  static constexpr int kSignedByte = 5120;
  const auto file = changed([](json& gltf) {
    const int indices = gltf["meshes"][0]["primitives"][0]["indices"];
    gltf["accessors"][indices]["componentType"] = kSignedByte;
  });
  EXPECT_THAT(refusal(file), HasSubstr("out of range"));
}

TEST_F(HandFile, AnAccessorBeyondItsBufferIsSaid) {
  const auto file = changed([](json& gltf) { gltf["accessors"][0]["count"] = 1000000; });
  EXPECT_THAT(refusal(file), HasSubstr("outside"));
}

TEST_F(HandFile, MoreVerticesThanIndicesCanNameAreSaid) {
  constexpr std::size_t kMost = 65535;
  HandMesh hand = mean_hand(Side::left);
  const auto grow_to = [&](std::size_t count) {
    hand.positions.resize(count, hand.positions[0]);
    hand.normals.resize(count, hand.normals[0]);
    hand.uv.resize(count, hand.uv[0]);
    hand.joints.resize(count, hand.joints[0]);
    hand.weights.resize(count, hand.weights[0]);
    hand.chart.resize(count, hand.chart[0]);
    EXPECT_TRUE(save_hand(hand, path("large.glb")));
    return path("large.glb");
  };
  const auto largest = load_hand(grow_to(kMost), Side::left);
  ASSERT_TRUE(largest) << largest.error().what;
  EXPECT_EQ(largest->vertex_count(), kMost);
  EXPECT_THAT(refusal(grow_to(kMost + 1)), HasSubstr("more than 65535 vertices"));
}

/// The mean hand with the axes of each joint turned by a turn of its own frame.
HandMesh with_axes(const std::function<glm::mat3(int)>& turn_of) {
  HandMesh hand = mean_hand(Side::left);
  for (int j = 0; j < kJoints; ++j) hand.rest[j] = hand.rest[j] * glm::mat4(turn_of(j));
  return hand;
}

float angle_deg(const glm::mat4& a, const glm::mat4& b) {
  const auto between = glm::transpose(glm::mat3(a)) * glm::mat3(b);
  return glm::degrees(
      std::acos(std::clamp((between[0][0] + between[1][1] + between[2][2] - 1) / 2, -1.f, 1.f)));
}

/// The mean hand lies there in the same way, joints included.
void expect_mean_hand(const Result<HandMesh>& read, Side side, float most_deg) {
  ASSERT_TRUE(read) << read.error().what;
  const auto& mean = mean_hand(side);
  EXPECT_EQ(read->side, side);
  ASSERT_EQ(read->vertex_count(), mean.vertex_count());
  for (std::size_t v = 0; v < mean.vertex_count(); ++v)
    ASSERT_LT(glm::distance(read->positions[v], mean.positions[v]), 1e-4f) << v;
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_LT(glm::distance(read->rest[j][3], mean.rest[j][3]), 1e-4f) << kJointNames[j];
    EXPECT_LT(angle_deg(read->rest[j], mean.rest[j]), most_deg) << kJointNames[j];
  }
}

constexpr float kExact_deg = 0.1f, kByPlaces_deg = 10;

TEST_F(HandFile, AxesThatOtherProgramsGiveBonesAreTurned) {
  const glm::mat3 along_y{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};  // Blender
  const glm::mat3 along_x{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  for (const auto& turn : {along_y, along_x, glm::transpose(along_x)}) {
    ASSERT_TRUE(save_hand(with_axes([&](int) { return glm::transpose(turn); }), path("odd.glb")));
    expect_mean_hand(load_hand(path("odd.glb"), Side::left), Side::left, kExact_deg);
  }
}

TEST_F(HandFile, AxesThatFollowNoRuleAreTakenFromThePlacesOfTheJoints) {
  const auto rolled = [](int joint) {
    const auto angle = static_cast<float>(joint * 2);
    return glm::mat3(
        glm::rotate(glm::mat4(1), angle, glm::normalize(glm::vec3(joint % 3, 1, joint % 2))));
  };
  ASSERT_TRUE(save_hand(with_axes(rolled), path("odd.glb")));
  expect_mean_hand(load_hand(path("odd.glb"), Side::left), Side::left, kByPlaces_deg);
  HandMesh all_alike = mean_hand(Side::left);  // those of the model, as from a tool for games
  for (auto& frame : all_alike.rest)
    for (int k = 0; k < 3; ++k) frame[k] = glm::mat4(1)[k == 0 ? 1 : k == 1 ? 2 : 0];
  ASSERT_TRUE(save_hand(all_alike, path("odd.glb")));
  expect_mean_hand(load_hand(path("odd.glb"), Side::left), Side::left, kByPlaces_deg);
}

/// Blender keeps the scale of an armature in its node, and its inverse in the matrices.
TEST_F(HandFile, TheScaleOfAnArmatureIsKnown) {
  HandMesh hand = mean_hand(Side::left);
  for (auto& position : hand.positions) position *= 100.f;
  for (auto& frame : hand.rest) frame[3] *= glm::vec4(100, 100, 100, 1);
  ASSERT_TRUE(save_hand(hand, path("centimetres.glb")));
  EXPECT_THAT(refusal(path("centimetres.glb")), HasSubstr("in metres"));
  const auto file = changed_of(path("centimetres.glb"), [](json& gltf) {
    gltf["nodes"].push_back(
        {{"name", "Armature"}, {"scale", {0.01, 0.01, 0.01}}, {"children", {1}}});
  });
  expect_mean_hand(load_hand(file, Side::left), Side::left, kExact_deg);
}

TEST_F(HandFile, AHandOfTheOtherSideIsRefusedByItsThumb) {
  ASSERT_TRUE(save_hand(mean_hand(Side::right), path("right.glb")));
  EXPECT_THAT(refusal(path("right.glb")),
              HasSubstr("it is a right hand, by its thumb; name it as hand.right"));
  EXPECT_TRUE(load_hand(path("right.glb"), Side::right));
}

TEST_F(HandFile, OfTwoHandsInOneMeshEachSideFindsItsOwn) {
  HandMesh both = mean_hand(Side::left);
  const auto count = both.vertex_count();
  const auto& right = mean_hand(Side::right);
  for (std::size_t v = 0; v < count; ++v) {
    both.positions.push_back(right.positions[v]), both.normals.push_back(right.normals[v]);
    both.uv.push_back(right.uv[v]), both.chart.push_back(right.chart[v]);
    auto joints = right.joints[v];
    for (auto& joint : joints) joint = static_cast<std::uint8_t>(joint + kJoints);
    both.joints.push_back(joints), both.weights.push_back(right.weights[v]);
  }
  for (auto triangle : right.triangles) {
    for (auto& v : triangle) v = static_cast<std::uint16_t>(v + count);
    both.triangles.push_back(triangle);
  }
  ASSERT_TRUE(save_hand(both, path("both.glb")));
  // The skin of the file gets the joints of the right hand too: twice as many nodes and matrices.
  std::string matrices;
  for (const Side side : {Side::left, Side::right})
    for (const auto& rest : mean_hand(side).rest) {
      const auto inverse = glm::inverse(rest);
      matrices.append(reinterpret_cast<const char*>(&inverse), sizeof inverse);
    }
  std::ofstream(path("matrices.bin"), std::ios::binary) << matrices;
  const auto file = changed_of(path("both.glb"), [&](json& gltf) {
    json skin{{"joints", json::array()}, {"inverseBindMatrices", gltf["accessors"].size()}};
    json nodes = json::array();
    for (const char* side : {".L", ".R"})
      for (const auto& name : kJointNames) {
        skin["joints"].push_back(nodes.size());
        nodes.push_back({{"name", std::string(name) + side}});
      }
    nodes.push_back({{"mesh", 0}, {"skin", 0}});
    gltf["buffers"].push_back({{"uri", "matrices.bin"}, {"byteLength", matrices.size()}});
    gltf["bufferViews"].push_back(
        {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", matrices.size()}});
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", 2 * kJoints},
                                 {"type", "MAT4"}});
    gltf["nodes"] = nodes;
    gltf["skins"] = json::array({skin});
    gltf.erase("scenes"), gltf.erase("scene");
  });
  for (const Side side : {Side::left, Side::right})
    expect_mean_hand(load_hand(file, side), side, kExact_deg);
}

TEST_F(HandFile, NamesOfOtherProgramsAreUnderstood) {
  for (const auto* style : {"%.L", "%.L.001", "l_%", "XR %", "% left"}) {
    const auto file = changed([&](json& gltf) {
      for (int j = 0; j < kJoints; ++j) {
        std::string name(style);
        name.replace(name.find('%'), 1, gltf["nodes"][j]["name"].get<std::string>());
        gltf["nodes"][j]["name"] = name;
      }
    });
    expect_mean_hand(load_hand(file, Side::left), Side::left, kExact_deg);
  }
  const auto unity = changed([&](json& gltf) {
    for (int j = 0; j < kJoints; ++j) {
      std::string name = "L_", from = gltf["nodes"][j]["name"];
      for (const std::string part : {"palm", "wrist", "thumb", "index", "middle", "ring", "pinky",
                                     "metacarpal", "proximal", "intermediate", "distal", "tip"})
        if (from.find(part) != std::string::npos)
          name += static_cast<char>(part[0] - 32) + part.substr(1);
      gltf["nodes"][j]["name"] = name;
    }
  });
  expect_mean_hand(load_hand(unity, Side::left), Side::left, kExact_deg);
}

TEST_F(HandFile, AMeshThatIsNoHandWhenItIsBentIsRefused) {
  HandMesh cuff = mean_hand(Side::left);
  for (auto& joints : cuff.joints) joints = {1, 1, 1, 1};
  ASSERT_TRUE(save_hand(cuff, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")),
              HasSubstr("no part of its mesh moves with the joints thumb-metacarpal"));
  HandMesh exchanged =
      mean_hand(Side::left);  // the index finger moves with the little finger's joints
  for (auto& joints : exchanged.joints)
    for (auto& joint : joints)
      joint = joint >= 6 && joint < 11 ? joint + 15 : joint >= 21 ? joint - 15 : joint;
  ASSERT_TRUE(save_hand(exchanged, path("odd.glb")));
  EXPECT_THAT(refusal(path("odd.glb")), HasSubstr("leave their finger"));
}

TEST_F(HandFile, RequiredExtensionsAreNamedWithTheRemedy) {
  for (const auto& [name, remedy] : {std::pair{"KHR_draco_mesh_compression", "without compression"},
                                     {"EXT_meshopt_compression", "without compression"},
                                     {"VENDOR_fancy", "without this extension"}}) {
    const auto file = changed([&](json& gltf) { gltf["extensionsRequired"] = {name}; });
    EXPECT_THAT(refusal(file), AllOf(HasSubstr(name), HasSubstr(remedy)));
  }
  EXPECT_TRUE(
      load_hand(changed([](json& gltf) { gltf["extensionsRequired"] = {"KHR_materials_unlit"}; }),
                Side::left));
}

TEST_F(HandFile, CasesThatOnceFailedAreTheMeanHand) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto folder = std::filesystem::path(data ? data : "../shared/data") / "cases/hands";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  for (const auto* name : {"bones_along_y.glb", "both_hands_right_first.glb", "cuff_first.glb",
                           "blender_suffix.glb"}) {
    SCOPED_TRACE(name);
    expect_mean_hand(load_hand(folder / name, Side::left), Side::left, kExact_deg);
  }
  expect_mean_hand(load_hand(folder / "both_hands_right_first.glb", Side::right), Side::right,
                   kExact_deg);
}

TEST_F(HandFile, TheHandsOfWebXrAreReadAsTheyAre) {
  const std::filesystem::path folder = "/usr/local/share/handcast-hands/webxr";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "not installed; see scripts/setup --hands";
  for (const Side side : {Side::left, Side::right}) {
    testing::internal::CaptureStderr();
    const auto read = load_hand(folder / (side == Side::left ? "left.glb" : "right.glb"), side);
    EXPECT_TRUE(read) << read.error().what;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

TEST_F(HandFile, MakeHandsSaysWhyItsFolderCannotBeCreated) {
  const char* bin = std::getenv("HANDCAST_BIN");
  if (!bin) GTEST_SKIP() << "HANDCAST_BIN is not set to the folder of the programs";
  std::ofstream(path("file")) << "not a folder";
  const auto log = path("log");
  const auto command = std::string(bin) + "/handcast-make-hands " +
                       (path("file") / "hands").string() + " 2>" + log.string();
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  std::ifstream in(log);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_THAT(text, AllOf(HasSubstr("hands cannot be created"), HasSubstr("Not a directory")));
}

TEST_F(HandFile, AFolderThatCannotBeWrittenIsSaid) {
  const auto result = save_hand(mean_hand(Side::left), path("no/such/folder/hand.glb"));
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace handcast::renderer
