#include "session.h"

#include <CLI/CLI.hpp>

namespace kinequad::app {

void Session::add_options(CLI::App& command) {
    command
        .add_option("--threads", threads_,
                    "Most threads to use; 0: all of the machine. Results do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    CLI::Option* quiet = command.add_flag("--quiet,-q", quiet_, "No progress, warnings only");
    command.add_flag("--verbose,-v", verbose_, "Say what every stage finds")->excludes(quiet);
}

Context Session::make_context() {
    console_ = std::make_unique<Console>(quiet_     ? Console::Detail::quiet
                                         : verbose_ ? Console::Detail::verbose
                                                    : Console::Detail::normal);
    Context context;
    context.threads = threads_;
    context.cancel = &interrupted_;
    context.progress = [this](std::string_view stage, double fraction) {
        console_->show_progress(stage, fraction);
    };
    context.log = [this](LogLevel level, std::string_view line) {
        console_->write_log(level, line);
    };
    return context;
}

void Session::finish() {
    if (console_) console_->finish();
}

}  // namespace kinequad::app
