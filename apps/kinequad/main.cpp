// The command line of Kinequad: one command a file; errors become one line and an exit code here.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "commands.h"
#include "interrupt.h"
#include "kinequad/core/error.h"
#include "kinequad/pipeline/version.h"
#include "session.h"

namespace kinequad::app {
namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 done, 1 internal failure, 2 usage, 3 file not read or written, 4 invalid mesh "
    "or\n"
    "sequence, 5 no valid symmetry, 6 no valid grid map, 7 the result failed verification,\n"
    "130 cancelled. Progress goes to stderr, results to stdout.";

int fail(Session& session, ExitCode code, std::string message) {
    session.finish();
    for (char& c : message) {
        if (c == '\n') c = ' ';
    }
    fmt::print(stderr, "kinequad: error: {}\n", message);
    return static_cast<int>(code);
}

int run_program(int argc, char** argv) {
    Session session(watch_interrupts());
    CLI::App program(
        "Kinequad: an animated triangle sequence in, one quad mesh for all its frames out.",
        "kinequad");
    program.set_version_flag("--version", std::string("kinequad ") + version);
    program.require_subcommand(1);
    program.footer(exit_codes);
    add_run_command(program, session);
    add_compare_command(program, session);
    add_measure_command(program, session);
    add_synth_command(program, session);
    add_render_command(program, session);
    add_symmetry_command(program, session);
    add_convert_command(program, session);
    try {
        program.parse(argc, argv);
        session.finish();
        return static_cast<int>(ExitCode::done);
    } catch (const CLI::Success& wanted) {  // --help, --version
        return program.exit(wanted);
    } catch (const CLI::ParseError& error) {
        return fail(session, ExitCode::usage,
                    fmt::format("{} (see kinequad --help)", error.what()));
    } catch (const Error& error) {
        return fail(session, error.code(), error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(session, ExitCode::file,
                    fmt::format("{}: {}", error.path1().string(), error.code().message()));
    } catch (const std::bad_alloc&) {
        return fail(session, ExitCode::internal_failure, "out of memory");
    } catch (const std::exception& error) {
        return fail(session, ExitCode::internal_failure,
                    fmt::format("internal failure: {}", error.what()));
    }
}

}  // namespace
}  // namespace kinequad::app

int main(int argc, char** argv) {
    try {
        return kinequad::app::run_program(argc, argv);
    } catch (...) {  // nothing could be written to stderr
        return static_cast<int>(kinequad::ExitCode::internal_failure);
    }
}
