// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/shadertoy_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "ipc/base/input_file.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/text.hpp"

namespace handcast::content::shader {
namespace {

namespace fs = std::filesystem;
using Channel = ShadertoyChannel;

/// kNowhere: what stands before the first heading if there is a file for what is common.
constexpr int kNowhere = -2, kCommon = -1, kImage = kShadertoyBuffers;

/// The text of a part, its lines on the lines of its file, and what it states of its channels.
struct PartText {
  fs::path file;
  std::string original, text;
  std::map<int, Channel> channels;
  bool is_there = false;
};
/// By kCommon, the numbers of buffers, and kImage.
using PartTexts = std::map<int, PartText>;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// "buffer A" as 0; empty if it is none.
std::optional<int> buffer_named(std::string_view text) {
  constexpr std::string_view kWord = "buffer";
  const auto words = lower(text);
  if (!words.starts_with(kWord)) return std::nullopt;
  const auto name = trimmed(std::string_view(words).substr(kWord.size()));
  if (name.size() != 1 || name[0] < 'a' || name[0] >= 'a' + kShadertoyBuffers) return std::nullopt;
  return name[0] - 'a';
}

/// Takes the words about wrapping and filtering from the end of a text.
void take_sampling(std::string_view& text, Channel& channel) {
  for (;;) {
    text = trimmed(text);
    const auto blank = text.find_last_of(" \t");
    if (blank == text.npos) return;
    const auto word = lower(text.substr(blank + 1));
    if (word == "linear" || word == "mipmap")
      channel.is_nearest = false;
    else if (word == "nearest")
      channel.is_nearest = true;
    else if (word == "clamp")
      channel.wrap = Channel::Wrap::clamp;
    else if (word == "repeat")
      channel.wrap = Channel::Wrap::repeat;
    else if (word == "mirror")
      channel.wrap = Channel::Wrap::mirror;
    else
      return;
    text = text.substr(0, blank);
  }
}

using ChannelWord = std::pair<std::string_view, Channel::From>;
constexpr ChannelWord kChannelWords[] = {{"input", Channel::From::input},
                                         {"sound", Channel::From::sound},
                                         {"none", Channel::From::nothing}};

/// Reads what stands behind "iChannel0 =". Errors (bad_config): the end of a sentence.
Result<Channel> read_channel(std::string_view text, const fs::path& folder) {
  Channel channel, sampled;
  auto what = text;
  take_sampling(what, sampled);
  const auto buffer = buffer_named(what);
  const auto word = lower(what);
  if (buffer) {
    channel.from = Channel::From::buffer;
    channel.buffer = *buffer;
  } else if (const auto* const found = std::ranges::find(kChannelWords, word, &ChannelWord::first);
             found != std::end(kChannelWords)) {
    channel.from = found->second;
  } else if (word.ends_with(".png") || word.ends_with(".jpg") || word.ends_with(".jpeg")) {
    channel.from = Channel::From::picture;
    channel.picture = folder / fs::path(what);
    channel.wrap = Channel::Wrap::repeat;
  } else {
    return fail(Errc::bad_config,
                fmt::format("{} is no channel; it is \"buffer A\" to \"buffer D\", \"input\", "
                            "\"sound\", \"none\", or a PNG or JPEG file",
                            quote(what)));
  }
  take_sampling(text, channel);
  return channel;
}

/// Reads the parts of one file, of which the first begins as `part`.
class PartReader {
 public:
  PartReader(PartTexts& parts, fs::path file, std::string original)
      : parts_(parts), file_(std::move(file)), original_(std::move(original)) {}

  Result<void> read(int part) {
    if (auto begun = begin(part); !begun) return begun;
    std::string_view rest = original_;
    while (!rest.empty()) {
      const auto end = std::min(rest.find('\n'), rest.size());
      ++lines_;
      if (auto taken = take(rest.substr(0, end)); !taken)
        return fail_in(fmt::format("{}:{}", file_.filename().string(), lines_), taken.error());
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
  }

 private:
  /// Its next line is the one behind those that have been read.
  Result<void> begin(int part) {
    part_ = &parts_[part];
    if (part_->is_there && part_->file != file_)
      return fail(Errc::bad_config, fmt::format("this part is in {}, too; keep one of them",
                                                part_->file.filename().string()));
    part_->is_there = true;
    part_->file = file_;
    part_->original = original_;
    part_->text.append(lines_ - static_cast<std::size_t>(std::ranges::count(part_->text, '\n')),
                       '\n');
    return {};
  }

  Result<void> take(std::string_view line) {
    const auto plain = trimmed(line);
    if (!plain.starts_with("//!")) {
      part_->text += std::string(line) + "\n";
      return {};
    }
    part_->text += "\n";
    const auto words = trimmed(plain.substr(3));
    const auto word = lower(words);
    if (word == "common") return begin(kCommon);
    if (word == "image") return begin(kImage);
    if (word.starts_with("buffer")) {
      if (const auto buffer = buffer_named(words)) return begin(*buffer);
      return fail(
          Errc::bad_config,
          fmt::format("{} is no buffer; there are \"buffer A\" to \"buffer D\"", quote(words)));
    }
    return word.starts_with("ichannel") ? take_channel(words) : Result<void>();
  }

  Result<void> take_channel(std::string_view words) {
    constexpr std::size_t kDigit = std::string_view("iChannel").size();
    const auto equals = words.find('=');
    const int number = words.size() > kDigit ? words[kDigit] - '0' : -1;
    if (number < 0 || number >= kShadertoyChannels || equals == words.npos ||
        trimmed(words.substr(kDigit + 1, equals - kDigit - 1)) != "")
      return fail(
          Errc::bad_config,
          fmt::format("{} is no channel; write e.g. \"//! iChannel0 = buffer A\"", quote(words)));
    auto channel = read_channel(words.substr(equals + 1), file_.parent_path());
    if (!channel) return tl::make_unexpected(channel.error());
    part_->channels[number] = std::move(*channel);
    return {};
  }

  PartTexts& parts_;
  fs::path file_;
  std::string original_;
  PartText* part_ = nullptr;
  std::size_t lines_ = 0;  ///< that have been read
};

/// True if a text has a line that begins a part.
bool has_headings(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto line = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (!line.starts_with("//!")) continue;
    const auto words = lower(trimmed(line.substr(3)));
    if (words == "common" || words == "image" || words.starts_with("buffer")) return true;
  }
  return false;
}

/// NAME.a.frag beside NAME.frag.
fs::path sibling_of(const fs::path& file, int part) {
  const std::string word =
      part == kCommon ? "common" : std::string(1, static_cast<char>('a' + part));
  return file.parent_path() /
         fmt::format("{}.{}{}", file.stem().string(), word, file.extension().string());
}

Result<PartTexts> read_parts(const fs::path& file, std::vector<fs::path>& files) {
  PartTexts parts;
  constexpr std::size_t kMostBytes = 4 << 20;
  files = {file};
  for (int part = kCommon; part < kImage; ++part) files.push_back(sibling_of(file, part));
  for (int part = kCommon; part < kImage; ++part) {
    std::error_code absent;
    const auto sibling = sibling_of(file, part);
    if (!fs::exists(sibling, absent)) continue;
    auto text = read_input(sibling, kMostBytes);
    if (!text) return tl::make_unexpected(text.error());
    if (auto read = PartReader(parts, sibling, std::move(*text)).read(part); !read)
      return tl::make_unexpected(read.error());
  }
  auto text = read_input(file, kMostBytes);
  if (!text) return tl::make_unexpected(text.error());
  const int before = parts[kCommon].is_there ? kNowhere : kCommon;
  const int first = has_headings(*text) ? before : kImage;
  if (auto read = PartReader(parts, file, std::move(*text)).read(first); !read)
    return tl::make_unexpected(read.error());
  return parts;
}

UserText user_text_of(PartText& part) {
  return {part.file, std::move(part.original), read_glsl(part.text)};
}

/// The channels of a part: those that it states, or that are common, or the buffers.
Result<std::array<Channel, kShadertoyChannels>> channels_of(PartTexts& parts, int part) {
  auto stated = parts[part].channels;
  if (stated.empty()) stated = parts[kCommon].channels;
  const bool is_plain = stated.empty();
  std::array<Channel, kShadertoyChannels> channels;
  for (int i = 0; i < kShadertoyChannels; ++i) {
    Channel& channel = channels[static_cast<std::size_t>(i)];
    if (is_plain && parts[i].is_there) {
      channel.from = Channel::From::buffer;
      channel.buffer = i;
    }
    if (stated.contains(i)) channel = stated[i];
    if (channel.from == Channel::From::buffer && !parts[channel.buffer].is_there)
      return fail(Errc::bad_config,
                  fmt::format("iChannel{} is the buffer {}, which there is not; write it below "
                              "a line \"//! buffer {}\"",
                              i, char('A' + channel.buffer), char('A' + channel.buffer)));
  }
  return channels;
}

Result<ShadertoyPart> part_of(PartTexts& parts, int part) {
  const auto name = parts[part].file.filename().string();
  auto channels = channels_of(parts, part);
  if (!channels) return fail_in(name, channels.error());
  const bool is_common = parts[kCommon].text.find("mainImage") != std::string::npos;
  ShadertoyPart made{user_text_of(parts[part]), *channels};
  if (!made.glsl.mentions("mainImage") && !is_common)
    return fail(Errc::bad_config,
                fmt::format("{}: {} has no mainImage(out vec4 fragColor, in vec2 fragCoord)", name,
                            part == kImage ? std::string("the image")
                                           : fmt::format("the buffer {}", char('A' + part))));
  return made;
}

}  // namespace

std::vector<const ShadertoyPart*> ShadertoyProgram::parts() const {
  std::vector<const ShadertoyPart*> all;
  for (const auto& buffer : buffers)
    if (buffer) all.push_back(&*buffer);
  all.push_back(&image);
  return all;
}

bool ShadertoyProgram::reads(Channel::From from) const {
  return std::ranges::any_of(parts(), [&](const auto* part) {
    return std::ranges::count(part->channels, from, &Channel::from) > 0;
  });
}

std::set<std::string, std::less<>> ShadertoyProgram::words() const {
  std::set<std::string, std::less<>> words;
  if (common) words = common->glsl.words;
  for (const auto* part : parts()) words.insert(part->glsl.words.begin(), part->glsl.words.end());
  return words;
}

Result<ShadertoyProgram> read_shadertoy(const fs::path& file) {
  ShadertoyProgram program;
  auto parts = read_parts(file, program.files);
  if (!parts) return tl::make_unexpected(parts.error());
  if (!(*parts)[kImage].is_there)
    return fail(Errc::bad_config, fmt::format("{}: it has no image; write it below a line \"//! "
                                              "image\"",
                                              file.filename().string()));
  for (int buffer = 0; buffer < kShadertoyBuffers; ++buffer) {
    if (!(*parts)[buffer].is_there) continue;
    auto part = part_of(*parts, buffer);
    if (!part) return tl::make_unexpected(part.error());
    program.buffers[static_cast<std::size_t>(buffer)] = std::move(*part);
  }
  auto image = part_of(*parts, kImage);
  if (!image) return tl::make_unexpected(image.error());
  program.image = std::move(*image);
  if ((*parts)[kCommon].is_there) program.common = user_text_of((*parts)[kCommon]);
  for (const auto* part : program.parts())
    for (const auto& channel : part->channels)
      if (channel.from == Channel::From::picture) program.files.push_back(channel.picture);
  return program;
}

}  // namespace handcast::content::shader
