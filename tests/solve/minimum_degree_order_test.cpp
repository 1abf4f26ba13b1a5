#include "kinequad/solve/minimum_degree_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace kinequad::test {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// n x n, the diagonal and an arrow of `arms` entries from the last columns to the last row.
SparseMatrix arrow(int n, int arms) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, i + 1 < n ? 1 : arms + 1);
    for (int i = n - 1 - arms; i + 1 < n; ++i) {
        entries.emplace_back(n - 1, i, 1);
        entries.emplace_back(i, n - 1, 1);
    }
    SparseMatrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

TEST(MinimumDegreeOrder, PutsTheHubOfAnArrowLastButOne) {
    // Eliminated first, the hub would join all arms; of the last two vertices either may come
    // first.
    MinimumDegreeOrder::PermutationType order;
    MinimumDegreeOrder()(arrow(50, 49), order);
    ASSERT_EQ(order.size(), 50);
    std::vector<int> times(50, 0);
    for (int i = 0; i < 50; ++i) ++times[static_cast<std::size_t>(order.indices()[i])];
    EXPECT_EQ(times, std::vector<int>(50, 1));
    const bool is_late = order.indices()[48] == 49 || order.indices()[49] == 49;
    EXPECT_TRUE(is_late);
}

TEST(MinimumDegreeOrder, AddsUpColumnNumbersBeyondThirtyTwoBits) {
    // A square grid, and a hub joined to so many of its last vertices that their numbers add up to
    // 2.5e9.
    constexpr int side = 640;
    constexpr int arms = 6200;
    constexpr int hub = side * side;
    std::vector<Eigen::Triplet<double>> entries;
    const auto join = [&](int i, int j) {
        entries.emplace_back(i, j, -1);
        entries.emplace_back(j, i, -1);
    };
    for (int i = 0; i < hub; ++i) {
        entries.emplace_back(i, i, 6);
        if ((i + 1) % side != 0) join(i, i + 1);
        if (i + side < hub) join(i, i + side);
    }
    entries.emplace_back(hub, hub, arms + 1);
    for (int i = hub - arms; i < hub; ++i) join(hub, i);
    SparseMatrix matrix(hub + 1, hub + 1);
    matrix.setFromTriplets(entries.begin(), entries.end());
    MinimumDegreeOrder::PermutationType order;
    MinimumDegreeOrder()(matrix, order);
    std::vector<int> sorted(order.indices().begin(), order.indices().end());
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i <= hub; ++i) ASSERT_EQ(sorted[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace kinequad::test
