#pragma once

#include <atomic>
#include <memory>

#include "console.h"
#include "kinequad/core/context.h"

namespace CLI {
class App;
}

namespace kinequad::app {

/// The options that every command has, and the context that follows from them.
class Session {
public:
    explicit Session(const std::atomic<bool>& interrupted) : interrupted_(interrupted) {}

    /// Adds --threads, --quiet and --verbose to a command.
    void add_options(CLI::App& command);
    /// What the library is given: threads, the console and the interrupt flag. The session
    /// has to outlive it.
    Context make_context();
    /// Takes the progress bar away, before results are printed.
    void finish();

private:
    const std::atomic<bool>& interrupted_;
    int threads_ = 0;
    bool quiet_ = false;
    bool verbose_ = false;
    std::unique_ptr<Console> console_;
};

}  // namespace kinequad::app
