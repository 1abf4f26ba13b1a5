#include "kinequad/core/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace kinequad {

void parallel_for(std::size_t count, std::size_t block, const Context& context,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    block = std::max<std::size_t>(block, 1);
    const std::size_t blocks = (count + block - 1) / block;
    const auto run_block = [&](std::size_t i) {
        context.check_cancelled();
        body(i * block, std::min(count, (i + 1) * block));
    };
    if (context.threads == 1 || blocks <= 1) {
        for (std::size_t i = 0; i < blocks; ++i) run_block(i);
        return;
    }
    tbb::task_arena arena(context.threads > 0 ? context.threads : tbb::task_arena::automatic);
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, blocks, run_block); });
}

void run_on_one_thread(const std::function<void()>& body) {
    tbb::task_arena arena(1);
    arena.execute(body);
}

}  // namespace kinequad
