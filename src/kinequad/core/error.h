#pragma once

#include <stdexcept>
#include <string>

namespace kinequad {

/// Exit codes of the program, one for each way a run can end.
enum class ExitCode {
    done = 0,
    internal_failure = 1,
    usage = 2,
    file = 3,
    invalid_mesh = 4,
    no_symmetry = 5,
    no_grid_map = 6,
    verification_failed = 7,
    cancelled = 130,
};

/// Base of everything that Kinequad throws on purpose. `what()` is one line that a user can act on.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    /// The exit code with which the program answers this error.
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// What kind of input is at fault; decides the exit code.
enum class InputFault {
    usage,     ///< an option or a value given by the user
    file,      ///< a file that cannot be read, parsed or written
    mesh,      ///< a mesh or sequence that is read but not valid
    symmetry,  ///< landmarks or a surface from which no symmetry map follows
};

/// Bad input: names the file, the element (line, vertex, triangle) and what to do about it.
class InputError : public Error {
public:
    InputError(InputFault fault, const std::string& message);
    InputFault fault() const { return fault_; }

private:
    InputFault fault_;
};

/// No valid grid map was found for a valid surface.
class GridMapError : public Error {
public:
    explicit GridMapError(const std::string& message, bool depends_on_density = true)
        : Error(ExitCode::no_grid_map, message), depends_on_density_(depends_on_density) {}
    /// Whether shorter edges of the quads might help.
    bool depends_on_density() const { return depends_on_density_; }

private:
    bool depends_on_density_;
};

/// A stage's result failed its own verifier; nothing is written.
class VerificationError : public Error {
public:
    explicit VerificationError(const std::string& message)
        : Error(ExitCode::verification_failed, message) {}
};

/// The user asked to stop.
class Cancelled : public Error {
public:
    Cancelled() : Error(ExitCode::cancelled, "cancelled") {}
};

/// Throws `InputError(fault, message)` unless `condition` holds. Always on: for what a user can get
/// wrong. `message` is only evaluated where it is a string already at hand; build costly messages
/// in an `if`.
inline void require(bool condition, InputFault fault, const std::string& message) {
    if (!condition) throw InputError(fault, message);
}

}  // namespace kinequad

/// Checks what only a programming error can break; compiled out in release builds.
#ifdef NDEBUG
#define KQ_DEBUG_ASSERT(condition) static_cast<void>(0)
#else
#define KQ_DEBUG_ASSERT(condition)                                                          \
    do {                                                                                    \
        if (!(condition)) throw std::logic_error("internal: " #condition " does not hold"); \
    } while (false)
#endif
