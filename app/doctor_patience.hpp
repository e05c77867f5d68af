#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <thread>
#include <utility>

namespace hitchview::app {

/// What `ask` returns, if it does so in time. What hangs is left behind, and its thread ends with
/// the process: `ask` owns whatever it uses.
template <typename Ask>
auto Within(std::chrono::milliseconds patience, Ask ask) -> std::optional<decltype(ask())> {
    std::promise<decltype(ask())> promise;
    auto answer = promise.get_future();
    std::thread([ask = std::move(ask), promise = std::move(promise)]() mutable {
        promise.set_value(ask());
    }).detach();
    if (answer.wait_for(patience) != std::future_status::ready) return std::nullopt;
    return answer.get();
}

}  // namespace hitchview::app
