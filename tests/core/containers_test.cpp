#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "kinequad/core/disjoint_sets.h"
#include "kinequad/core/sort_unique.h"

namespace kinequad {
namespace {

TEST(DisjointSets, AreNamedByTheirLowestMemberInWhateverOrder) {
    // Numbers that leave the same rest by 7 are joined along random pairs of neighbours.
    constexpr int count = 70;
    std::vector<int> joints(count - 7);
    std::iota(joints.begin(), joints.end(), 0);
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        std::shuffle(joints.begin(), joints.end(), random);
        DisjointSets sets(count);
        for (const int i : joints) {
            EXPECT_NE(sets.find(i), sets.find(i + 7));
            if (random() % 2 == 0) {
                sets.unite(i, i + 7);
            } else {
                sets.unite(i + 7, i);
            }
            EXPECT_EQ(sets.find(i), sets.find(i + 7));
        }
        for (int i = 0; i < count; ++i) EXPECT_EQ(sets.find(i), i % 7);
    }
}

TEST(SortUnique, KeepsOneOfEqualElementsInOrder) {
    std::vector<std::string> names = {"b", "a", "c", "a", "b", "a"};
    sort_unique(names);
    EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c"}));
    std::vector<int> none;
    sort_unique(none);
    EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace kinequad
