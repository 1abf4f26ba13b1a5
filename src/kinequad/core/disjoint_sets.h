#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "kinequad/core/index.h"

namespace kinequad {

/// Disjoint sets of the numbers below a count, which grow by being united; the lowest member names
/// a set, whatever the order.
class DisjointSets {
public:
    /// Every number below `count` in a set of its own.
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    /// The lowest member of the set of `i`.
    int find(int i) {
        while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
        return i;
    }
    /// Makes one set of those of `i` and `j`.
    void unite(int i, int j) {
        i = find(i);
        j = find(j);
        parent_[at(std::max(i, j))] = std::min(i, j);
    }

private:
    std::vector<int> parent_;
};

}  // namespace kinequad
