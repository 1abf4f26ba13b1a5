#include "kinequad/core/error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "kinequad/core/context.h"

namespace kinequad {
namespace {

TEST(Error, EveryFaultHasItsExitCode) {
    EXPECT_EQ(InputError(InputFault::usage, "").code(), ExitCode::usage);
    EXPECT_EQ(InputError(InputFault::file, "").code(), ExitCode::file);
    EXPECT_EQ(InputError(InputFault::mesh, "").code(), ExitCode::invalid_mesh);
    EXPECT_EQ(InputError(InputFault::symmetry, "").code(), ExitCode::no_symmetry);
    EXPECT_EQ(GridMapError("").code(), ExitCode::no_grid_map);
    EXPECT_EQ(VerificationError("").code(), ExitCode::verification_failed);
    EXPECT_EQ(Cancelled().code(), ExitCode::cancelled);
    EXPECT_EQ(static_cast<int>(ExitCode::cancelled), 130);
}

TEST(Error, RequireThrowsItsMessageOnlyWhereTheConditionFails) {
    EXPECT_NO_THROW(require(true, InputFault::mesh, "unused"));
    try {
        require(false, InputFault::file, "walk.pc2: truncated");
        FAIL() << "nothing was thrown";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "walk.pc2: truncated");
        EXPECT_EQ(error.fault(), InputFault::file);
    }
}

TEST(Context, ReportsNothingAfterCancellation) {
    std::atomic<bool> cancel{false};
    std::string seen;
    Context context;
    context.cancel = &cancel;
    context.progress = [&](std::string_view stage, double) { seen += stage; };
    context.report_progress("field", 0.5);
    EXPECT_EQ(seen, "field");
    cancel = true;
    EXPECT_THROW(context.report_progress("map", 0.5), Cancelled);
    EXPECT_EQ(seen, "field");
}

TEST(Context, WorksWithoutSinks) {
    const Context context;
    EXPECT_NO_THROW(context.report_progress("field", 1));
    EXPECT_NO_THROW(context.write_log(LogLevel::warning, "nobody listens"));
}

}  // namespace
}  // namespace kinequad
