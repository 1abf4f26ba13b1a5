#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "kinequad/core/context.h"

namespace kinequad::app {

/// What the user sees on stderr while a command works: a bar on a terminal, else a plain line when
/// a stage begins and every few seconds within it. Safe to use from several threads.
class Console {
public:
    enum class Detail {
        quiet,    ///< warnings only
        normal,   ///< progress and warnings
        verbose,  ///< progress and every log line
    };

    explicit Console(Detail detail);
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// Shows that `fraction` in [0, 1] of `stage` is done.
    void show_progress(std::string_view stage, double fraction);
    /// Writes a line above the bar.
    void write_log(LogLevel level, std::string_view line);
    /// Takes the bar away.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void clear_bar();

    Detail detail_;
    bool terminal_;
    std::mutex mutex_;
    std::string stage_;
    Clock::time_point last_shown_{};
    bool bar_shown_ = false;
};

}  // namespace kinequad::app
