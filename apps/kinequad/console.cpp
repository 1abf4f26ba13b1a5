#include "console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace kinequad::app {
namespace {

constexpr auto bar_interval = std::chrono::milliseconds(80);
constexpr auto line_interval = std::chrono::seconds(3);
constexpr int bar_width = 30;

}  // namespace

Console::Console(Detail detail) : detail_(detail), terminal_(isatty(STDERR_FILENO) != 0) {}

Console::~Console() { finish(); }

void Console::show_progress(std::string_view stage, double fraction) {
    if (detail_ == Detail::quiet) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const bool begins = stage != stage_;
    if (!begins && now - last_shown_ < (terminal_ ? Clock::duration(bar_interval)
                                                  : Clock::duration(line_interval))) {
        return;
    }
    stage_ = stage;
    last_shown_ = now;
    fraction = std::clamp(fraction, 0.0, 1.0);
    const int percent = static_cast<int>(std::floor(100 * fraction));
    if (!terminal_) {
        fmt::print(stderr, "{} {} %\n", stage, percent);
        return;
    }
    const int filled = static_cast<int>(std::lround(bar_width * fraction));
    fmt::print(stderr, "\r\033[K[{:#<{}}{:<{}}] {:3} %  {}", "", filled, "", bar_width - filled,
               percent, stage);
    std::fflush(stderr);
    bar_shown_ = true;
}

void Console::write_log(LogLevel level, std::string_view line) {
    if (level != LogLevel::warning && detail_ != Detail::verbose) return;
    const std::lock_guard lock(mutex_);
    clear_bar();
    fmt::print(stderr, "kinequad: {}{}\n", level == LogLevel::warning ? "warning: " : "", line);
}

void Console::finish() {
    const std::lock_guard lock(mutex_);
    clear_bar();
}

void Console::clear_bar() {
    if (!bar_shown_) return;
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
    bar_shown_ = false;
}

}  // namespace kinequad::app
