#pragma once

#include <string>
#include <utility>
#include <variant>

#include "hal/expect.hpp"

namespace hitchview::hal {

/// What the world did to us. Ordinary outcomes (kTimeout, kEndOfStream) are values here too.
enum class Error {
    kTimeout,       ///< nothing came in time; ordinary, call again
    kEndOfStream,   ///< a recording has no more; ordinary
    kDisconnected,  ///< the device is gone; reopen it
    kCorrupted,     ///< the data came, and is damaged
    kUnsupported,   ///< the device or file has a format we do not take
    kNotFound,      ///< no such device or file
    kTooLarge,      ///< does not fit the memory taken for it
    kFailed,        ///< the system refused; see the log
};

constexpr const char* ToString(Error error) {
    switch (error) {
        case Error::kTimeout:
            return "timeout";
        case Error::kEndOfStream:
            return "end of stream";
        case Error::kDisconnected:
            return "disconnected";
        case Error::kCorrupted:
            return "corrupted";
        case Error::kUnsupported:
            return "unsupported";
        case Error::kNotFound:
            return "not found";
        case Error::kTooLarge:
            return "too large";
        case Error::kFailed:
            return "failed";
    }
    return "unknown";
}

/// A value, or why there is none. Reading the wrong one is our bug and stops the process.
template <typename T, typename E = Error>
class [[nodiscard]] Result {
 public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(E error) : content_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return content_.index() == 0; }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& value() {
        HV_EXPECT(ok());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const T& value() const {
        HV_EXPECT(ok());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const E& error() const {
        HV_EXPECT(!ok());
        return *std::get_if<1>(&content_);
    }
    T& operator*() { return value(); }
    T* operator->() { return &value(); }

 private:
    std::variant<T, E> content_;
};

/// Success without a value.
struct Done {};

/// Set-up code (configuration, opening of devices) says why in words for a person.
template <typename T>
using Checked = Result<T, std::string>;

}  // namespace hitchview::hal
