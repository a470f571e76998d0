// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/plug_watch.hpp"

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "renderer/kms/card.hpp"

namespace handcast::renderer::kms {

PlugWatch::PlugWatch(int card, std::uint32_t connector_id)
    : thread_([this, card, connector_id](const std::stop_token& stop) {
        const sched_param none{};
        pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);  // the daemon may be real-time
        std::mutex mutex;
        std::condition_variable_any stopped;
        std::unique_lock lock(mutex);
        while (!stopped.wait_for(lock, stop, std::chrono::milliseconds(250),
                                 [&] { return stop.stop_requested(); }))
          is_plugged_ = kms::is_plugged(card, connector_id);
      }) {}

}  // namespace handcast::renderer::kms
