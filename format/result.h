// Result<T>: a value, or a sentence telling the user what went wrong and what to do about it.
#pragma once
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Process exit codes, the same for every program of the project. 128 + N: signal N ended it, as a shell would say.
enum class ExitCode
{
    kOk = 0,
    kUsage = 1,       // bad command line
    kIo = 2,          // a file cannot be read or written
    kInvalid = 3,     // a file was read but is not what it should be
    kDevice = 4,      // no suitable device, or out of (device) memory
    kUnsupported = 5, // valid input that needs a feature the project does not have
};

/// `message` is a full sentence without the leading "file: error:": what is wrong, where, and what to do.
struct Error
{
    ExitCode code = ExitCode::kInvalid;
    std::string message;
    std::string file = {}; // what the sentence is about where that is not the program's input; empty: the input
    std::vector<std::string> details = {}; // sentences that come before: what led to it

    Error about(std::string path) const { return {code, message, std::move(path), details}; }
};

template <typename T>
class [[nodiscard]] Result
{
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return state_.index() == 0; }
    T& operator*() { return std::get<0>(state_); }
    const T& operator*() const { return std::get<0>(state_); }
    T* operator->() { return &std::get<0>(state_); }
    const T* operator->() const { return &std::get<0>(state_); }
    const Error& error() const { return std::get<1>(state_); }

private:
    std::variant<T, Error> state_;
};

struct Success
{
};
using Status = Result<Success>; // for operations that only succeed or fail
