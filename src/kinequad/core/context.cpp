#include "kinequad/core/context.h"

#include "kinequad/core/error.h"

namespace kinequad {

void Context::check_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}

void Context::report_progress(std::string_view stage, double fraction) const {
    check_cancelled();
    if (progress) progress(stage, fraction);
}

void Context::write_log(LogLevel level, std::string_view line) const {
    if (log) log(level, line);
}

}  // namespace kinequad
