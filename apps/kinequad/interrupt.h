#pragma once

#include <atomic>

namespace kinequad::app {

/// Makes SIGINT and SIGTERM set the returned flag instead of ending the program. Work that does not
/// notice the flag within 0.8 s, or a second signal, ends the program with code 130 after the open
/// `OutputFolder`s are removed. To be called once, before any other thread is started, so that all
/// threads inherit the signal mask. The flag lives as long as the program.
const std::atomic<bool>& watch_interrupts();

}  // namespace kinequad::app
