// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/settings/choice.hpp"
#include "services/landmarks/inference/network.hpp"

namespace handcast::landmarks {

using config::Executor;

Result<std::unique_ptr<Network>> open_onednn_network(const std::filesystem::path& file);
Result<std::unique_ptr<Network>> open_opencv_network(const std::filesystem::path& file);

namespace {

struct Row {
  Executor executor;
  std::string_view library;
  Result<std::unique_ptr<Network>> (*open)(const std::filesystem::path& file);  ///< null: absent
};

constexpr std::array kTable{
    Row{Executor::onednn, "oneDNN", open_onednn_network},
#ifdef HANDCAST_WITH_OPENCV_DNN
    Row{Executor::opencv, "OpenCV's dnn module", open_opencv_network},
#else
    Row{Executor::opencv, "OpenCV's dnn module (HANDCAST_WITH_OPENCV_DNN)", nullptr},
#endif
};

}  // namespace

std::vector<Executor> executors() {
  std::vector<Executor> present;
  for (const Row& row : kTable)
    if (row.open) present.push_back(row.executor);
  return present;
}

Result<std::unique_ptr<Network>> open_network(Executor executor,
                                              const std::filesystem::path& file) {
  const Row& row = *std::ranges::find(kTable, executor, &Row::executor);
  if (row.open) return row.open(file);
  return fail(Errc::bad_config,
              fmt::format("the executor '{}' needs {}, which this build of handcast does not have",
                          config::word_of(executor), row.library));
}

}  // namespace handcast::landmarks
