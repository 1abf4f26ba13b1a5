#pragma once

#include <cstddef>
#include <functional>

#include "kinequad/core/context.h"

namespace kinequad {

/// Runs `body(begin, end)` over consecutive ranges of `block` indices that cover [0, count), on at
/// most `context.threads` threads. The ranges depend on `count` and `block` alone, never on the
/// number of threads, so that a body which writes one result a range gives the same bytes on every
/// machine. Throws what a body throws (one of them), and `Cancelled` between ranges.
void parallel_for(std::size_t count, std::size_t block, const Context& context,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs `body` on the calling thread, and the tasks of libraries that it calls as well, which would
/// else go to all cores.
void run_on_one_thread(const std::function<void()>& body);

}  // namespace kinequad
