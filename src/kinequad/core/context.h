#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace kinequad {

/// How much a log line matters.
enum class LogLevel { debug, info, warning };

/// What a computation is given beside its data: thread limit, where progress and log lines go,
/// and whether the user wants it to stop. Nothing is global and nothing random.
/// Copies share the sinks and the cancellation flag.
struct Context {
    /// Number of threads a stage may use; 0 means all that the machine has. Results do not depend
    /// on it.
    int threads = 0;
    /// Receives the name of a stage and the fraction of it that is done, in [0, 1]. May be empty.
    std::function<void(std::string_view stage, double fraction)> progress;
    /// Receives one log line without a newline at its end. May be empty.
    std::function<void(LogLevel level, std::string_view line)> log;
    /// Set by another thread or a signal handler to make running computations throw `Cancelled`.
    /// May be null; has to outlive the context.
    const std::atomic<bool>* cancel = nullptr;

    /// Throws `Cancelled` where the user asked to stop. Long loops call it at least every 100 ms.
    void check_cancelled() const;
    /// Hands on progress where there is a sink, after `check_cancelled`.
    void report_progress(std::string_view stage, double fraction) const;
    /// Hands on a log line where there is a sink.
    void write_log(LogLevel level, std::string_view line) const;
};

}  // namespace kinequad
