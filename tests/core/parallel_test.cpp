#include "kinequad/core/parallel.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

using Ranges = std::set<std::pair<std::size_t, std::size_t>>;

Ranges ranges_of(std::size_t count, std::size_t block, int threads) {
    Context context;
    context.threads = threads;
    std::mutex mutex;
    Ranges ranges;
    parallel_for(count, block, context, [&](std::size_t begin, std::size_t end) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(ranges.emplace(begin, end).second) << "a range came twice";
    });
    return ranges;
}

TEST(ParallelFor, RangesTileTheIndicesAndDoNotDependOnThreads) {
    for (const std::size_t count : {0U, 1U, 7U, 64U, 1000U}) {
        for (const std::size_t block : {0U, 1U, 7U, 64U, 2000U}) {
            const Ranges expected = ranges_of(count, block, 1);
            std::size_t reached = 0;
            for (const auto& [begin, end] : expected) {
                EXPECT_EQ(begin, reached);
                EXPECT_GT(end, begin);
                reached = end;
            }
            EXPECT_EQ(reached, count);
            for (const int threads : {0, 2, 8})
                EXPECT_EQ(ranges_of(count, block, threads), expected);
        }
    }
}

TEST(ParallelFor, SumsAFloatingSeriesToTheSameBytesOnAnyThreadCount) {
    const auto sum_with = [](int threads) {
        constexpr std::size_t count = 100000;
        constexpr std::size_t block = 1024;
        Context context;
        context.threads = threads;
        std::vector<double> partial((count + block - 1) / block, 0.0);
        parallel_for(count, block, context, [&](std::size_t begin, std::size_t end) {
            double sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i));
            partial[begin / block] = sum;
        });
        double total = 0;
        for (const double sum : partial) total += sum;
        return total;
    };
    const double one = sum_with(1);
    EXPECT_EQ(one, sum_with(2));
    EXPECT_EQ(one, sum_with(8));
}

TEST(ParallelFor, StopsWhenCancelled) {
    for (const int threads : {1, 2}) {
        std::atomic<bool> cancel{false};
        std::atomic<int> calls{0};
        Context context;
        context.threads = threads;
        context.cancel = &cancel;
        const auto body = [&](std::size_t, std::size_t) {
            ++calls;
            cancel = true;
        };
        EXPECT_THROW(parallel_for(100000, 1, context, body), Cancelled);
        EXPECT_LE(calls, threads);
    }
}

TEST(ParallelFor, HandsOnWhatABodyThrows) {
    for (const int threads : {1, 2}) {
        Context context;
        context.threads = threads;
        EXPECT_THROW(parallel_for(100, 1, context,
                                  [](std::size_t begin, std::size_t) {
                                      if (begin == 57) throw std::domain_error("57");
                                  }),
                     std::domain_error);
    }
}

TEST(RunOnOneThread, KeepsTasksOfOthersToItself) {
    std::atomic<int> elsewhere{0};
    run_on_one_thread([&] {
        const std::thread::id here = std::this_thread::get_id();
        tbb::parallel_for(0, 1000, [&](int) {
            if (std::this_thread::get_id() != here) ++elsewhere;
        });
    });
    EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelFor, NestsInsideItself) {
    Context context;
    context.threads = 2;
    std::atomic<int> calls{0};
    parallel_for(8, 1, context, [&](std::size_t, std::size_t) {
        parallel_for(8, 1, context, [&](std::size_t, std::size_t) { ++calls; });
    });
    EXPECT_EQ(calls, 64);
}

}  // namespace
}  // namespace kinequad
