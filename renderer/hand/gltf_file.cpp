// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "ipc/base/input_file.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::renderer {
namespace {

/// Keeps tinygltf from decoding pictures, which are not used.
bool ignore_picture(tinygltf::Image*, int, std::string*, std::string*, int, int,
                    const unsigned char*, int, void*) {
  return true;
}

/// Deeper JSON is refused: tinygltf follows it by recursion. A hand has a depth of about ten.
constexpr int kMostDepth = 64;

/// The JSON of a .gltf file or of the first chunk of a .glb file.
std::string_view json_of(std::string_view bytes) {
  constexpr std::size_t kHeader = 20;  // magic, version, length; length and type of the chunk
  if (!bytes.starts_with("glTF") || bytes.size() < kHeader) return bytes;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return bytes.substr(kHeader, length);
}

int depth_of(std::string_view json) {
  int depth = 0, most = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_text = !in_text;
    if (in_text) {
      i += c == '\\';  // the next character is escaped
      continue;
    }
    if (c == '{' || c == '[') most = std::max(most, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  return most;
}

/// Reads a buffer that lies in a file of its own. `left`: std::uint64_t, the bytes that all of them
/// may still have.
bool read_buffer(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                 void* left) {
  auto& left_bytes = *static_cast<std::uint64_t*>(left);
  const auto read = read_input(path, left_bytes);
  if (!read) {
    *error = read.error().what;
    return false;
  }
  left_bytes -= read->size();
  bytes->assign(read->begin(), read->end());
  return true;
}

/// tinygltf's own check opens the file, which blocks on a pipe.
bool is_file(const std::string& path, void*) {
  std::error_code unknown;
  return std::filesystem::is_regular_file(path, unknown);
}

tinygltf::FsCallbacks files(std::uint64_t& left_bytes) {
  return {.FileExists = is_file,
          .ExpandFilePath = &tinygltf::ExpandFilePath,
          .ReadWholeFile = read_buffer,
          .WriteWholeFile = &tinygltf::WriteWholeFile,
          .user_data = &left_bytes};
}

bool parse(const std::filesystem::path& file, const std::string& bytes, tinygltf::Model& model,
           std::string& error) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(ignore_picture, nullptr);
  std::uint64_t left_bytes = kMostMesh;
  loader.SetFsCallbacks(files(left_bytes));
  std::string warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const auto folder = file.parent_path().string();
  try {
    return bytes.starts_with("glTF")
               ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size, folder)
               : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& exception) {
    error = exception.what();
    return false;
  }
}

}  // namespace

Result<tinygltf::Model> read_gltf(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostMesh);
  if (!bytes) return fail_in("hand", bytes.error());
  const auto refuse = [&](const std::string& why) {
    return fail(Errc::bad_config,
                fmt::format("hand '{}': it is not a valid glTF file ({})", file.string(), why));
  };
  if (depth_of(json_of(*bytes)) > kMostDepth)
    return refuse(fmt::format("its JSON is nested more than {} deep", kMostDepth));
  tinygltf::Model model;
  std::string error;
  if (!parse(file, *bytes, model, error))
    return refuse(shown_line(error.substr(0, error.find('\n')), 300));
  return model;
}

}  // namespace handcast::renderer
