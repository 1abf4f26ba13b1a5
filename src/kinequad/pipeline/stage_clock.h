#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace kinequad {

/// What one stage of a run took.
struct StageTime {
    std::string stage;
    double wall_seconds = 0;
    double cpu_seconds = 0;  ///< of the whole process, all threads together
};

/// Measures stages that follow one another: each ends where the next begins.
class StageClock {
public:
    StageClock();
    /// Adds the time since construction or the last call to `times`, under the name `stage`, to
    /// what is there by that name.
    void finish_stage(std::string stage, std::vector<StageTime>& times);

private:
    std::chrono::steady_clock::time_point wall_;
    double cpu_;
};

/// CPU time of this process since it began, all threads together, in seconds.
double process_cpu_seconds();

}  // namespace kinequad
