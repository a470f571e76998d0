// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>

#include "services/content/projegraphy/http.hpp"
#include "services/content/projegraphy/silhouette.hpp"

namespace handcast::projegraphy {

/// Servers that take the place of what is built in; what is empty is not used.
struct Servers {
  std::string recogniser;  ///< of the OpenAI kind: the address before /v1/chat/completions
  std::string painter;     ///< of the Stable Diffusion WebUI: the address before /sdapi/v1/txt2img
  std::string workflow;    ///< the painter is ComfyUI, and this is what it does: see by_workflow()
  std::string model;       ///< of the recogniser
  std::string key;         ///< of the recogniser
  std::string style = "A cute";  ///< begins the painter's prompt
  double patience_s = 8;         ///< for each request
  int per_hour = 60;             ///< requests to both
  int tries = 3;                 ///< of each

  bool operator==(const Servers&) const = default;
};

/// Asks the servers, within their budget. What leaves the computer is the mask. A server that does
/// not answer is left alone for 20 s. One thread.
class Remote {
 public:
  /// Which of animals() a silhouette is; -1: none. Errors: those of fetch(), bad_data (not that
  /// JSON, or no animal of ours: nothing else is shown), unavailable (the budget of the hour is
  /// spent).
  Result<int> animal_of(const Servers& servers, const Silhouette& silhouette,
                        const std::stop_token& stop);
  /// A picture of an animal in the shape of a silhouette, kPictureSide_px square, opaque. Errors:
  /// as animal_of(), bad_data (no picture).
  Result<renderer::Texture> picture_of(const Servers& servers, const Silhouette& silhouette,
                                       std::string_view animal, const std::stop_token& stop);

 private:
  Result<std::string> ask(const Servers& servers, const Request& request,
                          const std::stop_token& stop);
  /// picture_of() by ComfyUI: uploads the mask, queues the workflow, waits for its picture.
  Result<renderer::Texture> by_workflow(const Servers& servers, const Silhouette& silhouette,
                                        std::string_view animal, const std::stop_token& stop);

  std::deque<std::int64_t> asked_ns_;              ///< in the last hour
  std::map<std::string, std::int64_t> silent_ns_;  ///< when an address did not answer
};

/// A key, and the one server that gets it: whoever may choose the recogniser does not get the key.
struct ServerKey {
  std::string server, key;

  /// The key for a server; "" if it is for another one.
  std::string for_server(const std::string& address) const;
};

/// The workflow of ComfyUI in a file, as it exports them for its API: its texts HANDCAST_PROMPT and
/// HANDCAST_MASK stand for the prompt and for the name of the mask. Errors (bad_config): the file
/// cannot be read, or is none.
Result<std::string> read_workflow(const std::string& file);

/// "ADDRESS KEY" in a file, or else in $HANDCAST_PROJEGRAPHY_KEY; empty if there is none. Errors
/// (bad_config): the file cannot be read or does not hold these two words.
Result<ServerKey> read_key(const std::string& file);

}  // namespace handcast::projegraphy
