// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/hand_network.hpp"

#include <fmt/format.h>

#include "ipc/base/clock.hpp"
#include "services/landmarks/finder/models.hpp"

namespace handcast::landmarks {
namespace {

namespace fs = std::filesystem;
using Shape = std::vector<int>;

/// What a file must be for a network to be the one it is taken for.
struct Ports {
  const char* what;
  Shape input;
  std::vector<Shape> outputs;
};

const Ports& hand_ports() {
  static const Ports kPorts{
      "the hand landmark network", {1, 224, 224, 3}, {{1, 63}, {1, 1}, {1, 1}, {1, 63}}};
  return kPorts;
}

const Ports& palm_ports() {
  static const Ports kPorts{"the palm network",
                            {1, kPalmSide_px, kPalmSide_px, 3},
                            {{1, kPalmAnchors, kPalmValues}, {1, kPalmAnchors, 1}}};
  return kPorts;
}

std::string describe(std::span<const Network::Port> ports) {
  std::string text;
  for (const auto& port : ports)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", fmt::join(port.shape, "x"));
  return text;
}

bool has_ports(const Network& network, const Ports& ports) {
  if (network.inputs().size() != 1 || network.inputs()[0].shape != ports.input) return false;
  if (network.outputs().size() != ports.outputs.size()) return false;
  for (std::size_t i = 0; i < ports.outputs.size(); ++i)
    if (network.outputs()[i].shape != ports.outputs[i]) return false;
  return true;
}

Result<std::unique_ptr<Network>> open(const std::string& backend, const fs::path& file,
                                      const Ports& ports) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    return fail(
        Errc::bad_config,
        fmt::format(
            "'{}' is missing; scripts/get-models fetches it, landmarks.models names another folder",
            file.string()));
  auto network = open_network(backend, file);
  if (!network) return network;
  if (!has_ports(**network, ports))
    return fail(Errc::bad_config,
                fmt::format("'{}' is not {}: it takes {} and gives {}", file.string(), ports.what,
                            describe((*network)->inputs()), describe((*network)->outputs())));
  return network;
}

}  // namespace

Result<HandNetwork> HandNetwork::open(const std::string& backend, const fs::path& folder) {
  auto network = landmarks::open(backend, folder / kHandModel, hand_ports());
  if (!network) return tl::make_unexpected(network.error());
  return HandNetwork(std::move(*network));
}

Result<HandNetwork::Seen> HandNetwork::look(renderer::GreyView image, const Region& region,
                                            Times& times) {
  const std::int64_t begin_ns = now_ns();
  crop_.cut(image, region);
  crop_.write_rgb(network_->input(0));
  const std::int64_t cut_ns = now_ns();
  const auto done = network_->run();
  times.crop_ns += cut_ns - begin_ns;
  times.network_ns += now_ns() - cut_ns;
  if (!done) return tl::make_unexpected(done.error());

  Seen seen;
  const auto values = network_->output(0);  // x, y, z of each point in px of the crop, 0 the middle
                                            // of its first pixel: see the test of mirrored images
  for (std::size_t i = 0; i < seen.points_px.size(); ++i)
    seen.points_px[i] = region.to_image(
        (glm::vec2(values[3 * i], values[3 * i + 1]) + 0.5f) / static_cast<float>(kSide_px) - 0.5f);
  seen.presence = network_->output(1)[0];
  seen.left_score =
      1 -
      network_->output(
          2)[0];  // of a right hand; MediaPipe, which takes images for mirrored, calls it "Left"
  return seen;
}

Result<PalmNetwork> PalmNetwork::open(const std::string& backend, const fs::path& folder) {
  auto network = landmarks::open(backend, folder / kPalmModel, palm_ports());
  if (!network) return tl::make_unexpected(network.error());
  return PalmNetwork(std::move(*network));
}

Result<std::vector<Region>> PalmNetwork::search(renderer::GreyView image) {
  const Region whole = region_of_image(image.width, image.height);
  crop_.cut(image, whole);
  crop_.write_rgb(network_->input(0));
  if (const auto done = network_->run(); !done) return tl::make_unexpected(done.error());
  std::vector<Region> regions;
  for (const auto& palm : decode_palms(network_->output(0), network_->output(1)))
    regions.push_back(region_of_palm(palm, whole));
  return regions;
}

}  // namespace handcast::landmarks
