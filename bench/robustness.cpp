// Runs the program on every mesh it is given, each with a time limit, checks what it wrote without
// trusting what it said, and prints a table and a summary. Called by scripts/robustness.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/measure/mesh_counts.h"
#include "kinequad/measure/quad_shape.h"

namespace {

using namespace kinequad;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Settings {
    std::string program;
    std::string output = "out/robustness";
    std::vector<int> vertices = {2000};
    std::vector<std::string> inputs;
    std::vector<std::string> options;
    double limit_seconds = 120;
    unsigned jobs = 1;
    bool refusal_is_right = false;
};

struct Job {
    std::string input;
    int vertices = 0;
    fs::path folder;
};

struct Outcome {
    int exit_code = -1;  ///< -1 where it was killed
    bool timed_out = false;
    double seconds = 0;  ///< CPU
    double gibibytes = 0;
    std::string message;  ///< the last line on stderr, or what is wrong with the result
    bool is_verified = false;
    int made_vertices = 0;
    int quads = 0;
    int folded = 0;
    double irregular_percent = 0;
    bool off_target = false;   ///< more than 10 % from the wanted number of vertices
    bool said_reason = false;  ///< and run.json says why
};

std::string read_text(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::string last;
    while (std::getline(lines, line)) {
        if (!line.empty()) last = line;
    }
    return last;
}

/// Runs the program as a child with its output in files; kills it after the limit.
void run_program(const Settings& settings, const Job& job, Outcome& outcome) {
    std::vector<std::string> arguments = {settings.program, "run", job.input, "-o",
                                          job.folder.string()};
    if (job.vertices > 0) {
        arguments.insert(arguments.end(), {"--vertices", std::to_string(job.vertices)});
    }
    arguments.insert(arguments.end(), settings.options.begin(), settings.options.end());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string log = job.folder.string() + ".log";

    const pid_t child = fork();
    if (child == 0) {
        // CPU time does not depend on what else the machine does.
        const auto limit = static_cast<rlim_t>(settings.limit_seconds);
        const rlimit cpu{limit, limit + 1};
        setrlimit(RLIMIT_CPU, &cpu);
        const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        const int none = open("/dev/null", O_WRONLY);
        dup2(file, STDERR_FILENO);
        dup2(none, STDOUT_FILENO);
        execv(argv[0], argv.data());
        _exit(127);
    }
    const auto start = Clock::now();
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, WNOHANG, &usage) == 0) {
        const double waited = std::chrono::duration<double>(Clock::now() - start).count();
        if (waited > 10 * settings.limit_seconds) {
            outcome.timed_out = true;
            kill(child, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    outcome.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    outcome.gibibytes = static_cast<double>(usage.ru_maxrss) / (1 << 20);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    outcome.message = last_line(read_text(log));
    outcome.timed_out = outcome.timed_out || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU);
    if (outcome.timed_out) {
        outcome.message = fmt::format("not done after {:.0f} s of CPU; last: {}",
                                      settings.limit_seconds, outcome.message);
    } else if (WIFSIGNALED(status)) {
        outcome.message =
            fmt::format("killed by signal {}; last: {}", WTERMSIG(status), outcome.message);
    }
}

/// What is wrong with the quads on disk for an input with these counts; empty where nothing is.
std::string find_fault(const MeshCounts& made, const nlohmann::json& record) {
    const nlohmann::json& input = record.at("input");
    if (made.quads != made.faces)
        return fmt::format("{} faces are no quads", made.faces - made.quads);
    if (!made.is_manifold() || made.misoriented_edges > 0 || made.duplicate_faces > 0) {
        return "the result is not manifold";
    }
    if (made.components != input.at("components").get<int>()) {
        return fmt::format("{} components", made.components);
    }
    if (made.boundary_loops != input.at("boundary_loops").get<int>()) {
        return fmt::format("{} boundary loops", made.boundary_loops);
    }
    if (made.euler_characteristic != input.at("euler_characteristic").get<int>()) {
        return fmt::format("Euler characteristic {}", made.euler_characteristic);
    }
    if (record.at("map").at("flipped_triangles").get<int>() != 0) return "flipped triangles";
    return {};
}

fs::path first_frame(const fs::path& folder) {
    for (const char* name : {"quads.obj", "quads/quads_0000.obj"}) {
        if (fs::exists(folder / name)) return folder / name;
    }
    return folder / "quads.obj";
}

void check_result(const Job& job, Outcome& outcome) {
    const nlohmann::json record = nlohmann::json::parse(read_text(job.folder / "run.json"));
    const PolygonMesh quads = read_polygon_mesh(first_frame(job.folder));
    const MeshCounts counts = count_mesh(quads.faces, static_cast<int>(quads.V.rows()));
    const std::string fault = find_fault(counts, record);
    outcome.is_verified = fault.empty();
    if (!fault.empty()) outcome.message = fault;
    outcome.made_vertices = counts.vertices;
    outcome.quads = counts.quads;
    outcome.irregular_percent = counts.irregular_percent();
    outcome.folded = measure_shape(quads.V, quads.faces).folded_quads;
    const double ratio = job.vertices > 0 ? 1.0 * counts.vertices / job.vertices : 1.0;
    outcome.off_target = ratio < 0.9 || ratio > 1.1;
    const auto notes = record.find("notes");
    outcome.said_reason = notes != record.end() && !notes->empty();
    if (outcome.said_reason && fault.empty()) outcome.message = notes->back().get<std::string>();
}

Outcome run_job(const Settings& settings, const Job& job) {
    Outcome outcome;
    fs::remove_all(job.folder);
    run_program(settings, job, outcome);
    if (outcome.exit_code == 0) {
        outcome.message.clear();
        try {
            check_result(job, outcome);
        } catch (const std::exception& error) {
            outcome.message = error.what();
        }
    } else if (fs::exists(job.folder / "run.json")) {
        outcome.exit_code = -1;
        outcome.message = "failed and left a result: " + outcome.message;
    }
    return outcome;
}

bool is_right(const Settings& settings, const Outcome& outcome) {
    if (outcome.is_verified) return true;
    return settings.refusal_is_right && (outcome.exit_code == 3 || outcome.exit_code == 4) &&
           !outcome.message.empty();
}

std::string cell(std::string text) {
    std::replace(text.begin(), text.end(), '|', '/');
    constexpr std::size_t most = 200;
    if (text.size() > most) text = text.substr(0, most) + "...";
    return text;
}

void print_table(const Settings& settings, const std::vector<Job>& jobs,
                 const std::vector<Outcome>& outcomes) {
    fmt::print(
        "| input | wanted | outcome | vertices | folded / quads | irregular % | CPU s | GiB | note "
        "|\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const Outcome& o = outcomes[i];
        const std::string result = o.is_verified ? "verified"
                                   : is_right(settings, o)
                                       ? fmt::format("refused ({})", o.exit_code)
                                   : o.timed_out ? "TIME LIMIT"
                                                 : fmt::format("FAILED ({})", o.exit_code);
        fmt::print("| {} | {} | {} | {} | {} / {} | {:.2f} | {:.1f} | {:.2f} | {} |\n",
                   fs::path(jobs[i].input).filename().string(), jobs[i].vertices, result,
                   o.made_vertices, o.folded, o.quads, o.irregular_percent, o.seconds, o.gibibytes,
                   cell(o.message));
    }
}

int print_summary(const Settings& settings, const std::vector<Job>& jobs,
                  const std::vector<Outcome>& outcomes) {
    int right = 0;
    int verified = 0;
    long quads = 0;
    long folded = 0;
    int off_target = 0;
    int unexplained = 0;
    double total = 0;
    double most_memory = 0;
    std::size_t slowest = 0;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const Outcome& o = outcomes[i];
        right += is_right(settings, o) ? 1 : 0;
        verified += o.is_verified ? 1 : 0;
        quads += o.quads;
        folded += o.folded;
        off_target += o.is_verified && o.off_target ? 1 : 0;
        unexplained += o.is_verified && o.off_target && !o.said_reason ? 1 : 0;
        total += o.seconds;
        most_memory = std::max(most_memory, o.gibibytes);
        if (o.seconds > outcomes[slowest].seconds) slowest = i;
    }
    fmt::print("\n{} of {} verified", verified, outcomes.size());
    if (settings.refusal_is_right) fmt::print(", {} refused with a reason", right - verified);
    fmt::print(
        "; {} folded of {} quads ({:.3f} in 1,000); {} off the wanted number by more than 10 % ({} "
        "without a reason); slowest {:.1f} s of CPU ({} at {}), total {:.0f} s; most memory {:.2f} "
        "GiB\n",
        folded, quads,
        quads > 0 ? 1000.0 * static_cast<double>(folded) / static_cast<double>(quads) : 0.0,
        off_target, unexplained, outcomes[slowest].seconds,
        fs::path(jobs[slowest].input).filename().string(), jobs[slowest].vertices, total,
        most_memory);
    return right == static_cast<int>(outcomes.size()) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Runs kinequad on many meshes and tabulates what comes out");
    app.add_option("--program", settings.program, "The kinequad program")->required();
    app.add_option("--output", settings.output, "Folder for results and logs");
    app.add_option("--vertices", settings.vertices, "Wanted numbers of vertices; 0: the default");
    app.add_option("--limit", settings.limit_seconds, "Seconds of CPU that a run may take");
    app.add_option("--jobs", settings.jobs, "Runs at the same time")->check(CLI::PositiveNumber);
    app.add_option("--options", settings.options,
                   "Further options of kinequad run, in one word each")
        ->allow_extra_args();
    app.add_flag("--refusals", settings.refusal_is_right,
                 "Exit codes 3 and 4 with a message are right");
    app.add_option("--inputs", settings.inputs, "Meshes and sequences")->required();
    CLI11_PARSE(app, argc, argv);

    std::vector<Job> jobs;
    for (const int vertices : settings.vertices) {
        for (const std::string& input : settings.inputs) {
            jobs.push_back(
                {input, vertices,
                 fs::path(settings.output) /
                     fmt::format("{}-{}", fs::path(input).filename().string(), vertices)});
        }
    }
    fs::create_directories(settings.output);
    std::vector<Outcome> outcomes(jobs.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < jobs.size(); i = next++) {
            outcomes[i] = run_job(settings, jobs[i]);
            const Outcome& o = outcomes[i];
            fmt::print(stderr, "{} at {}: {} {:.1f} s {}\n",
                       fs::path(jobs[i].input).filename().string(), jobs[i].vertices,
                       is_right(settings, o) ? "right" : "WRONG", o.seconds, o.message);
        }
    };
    std::vector<std::thread> workers;
    for (unsigned i = 0; i < settings.jobs; ++i) workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
    print_table(settings, jobs, outcomes);
    return print_summary(settings, jobs, outcomes);
}
