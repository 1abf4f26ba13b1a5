#pragma once

#include "session.h"

namespace kinequad::app {

/// Each adds one command with its options to the program; parsing the command line runs it.
void add_run_command(CLI::App& program, Session& session);
void add_compare_command(CLI::App& program, Session& session);
void add_measure_command(CLI::App& program, Session& session);
void add_symmetry_command(CLI::App& program, Session& session);
void add_synth_command(CLI::App& program, Session& session);
void add_render_command(CLI::App& program, Session& session);
void add_convert_command(CLI::App& program, Session& session);

}  // namespace kinequad::app
