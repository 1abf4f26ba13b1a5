#include "kinequad/pipeline/stage_clock.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace kinequad {

double process_cpu_seconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

StageClock::StageClock() : wall_(std::chrono::steady_clock::now()), cpu_(process_cpu_seconds()) {}

void StageClock::finish_stage(std::string stage, std::vector<StageTime>& times) {
    const auto wall = std::chrono::steady_clock::now();
    const double cpu = process_cpu_seconds();
    auto time = std::find_if(times.begin(), times.end(),
                             [&](const StageTime& earlier) { return earlier.stage == stage; });
    if (time == times.end()) time = times.insert(time, StageTime{std::move(stage)});
    time->wall_seconds += std::chrono::duration<double>(wall - wall_).count();
    time->cpu_seconds += cpu - cpu_;
    wall_ = wall;
    cpu_ = cpu;
}

}  // namespace kinequad
