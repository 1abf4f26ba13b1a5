#include "kinequad/symmetry/find_wrong_landmarks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace kinequad {
namespace {

/// Landmarks on a line of places: pairs of -x and x, and the middle 0 as stationary vertex. Vertex
/// 2 p is the left end of pair p, 2 p + 1 the right one, 2 n the middle.
class WrongLandmarks : public testing::Test {
protected:
    WrongLandmarks() {
        const int pairs = 5;
        for (int p = 0; p < pairs; ++p) {
            good.pairs.push_back({2 * p, 2 * p + 1});
            place.insert(place.end(), {-10.0 * (p + 1), 10.0 * (p + 1)});
        }
        good.stationary.push_back(2 * pairs);
        place.push_back(0);
        for (std::size_t v = 0; v < place.size(); ++v) {
            distances.source.push_back(static_cast<int>(v));
            std::vector<double>& row = distances.distance.emplace_back();
            for (const double x : place) row.push_back(std::abs(x - place[v]));
        }
    }

    double left_over(const std::array<int, 2>& pair) const {
        return std::abs(place[static_cast<std::size_t>(pair[0])] +
                        place[static_cast<std::size_t>(pair[1])]);
    }

    /// A map that is as far from an involution as its landmarks are wrong.
    LandmarkTrial trial(const SphereLandmarks& some, const SphereLandmarks& asked) const {
        LandmarkTrial result;
        for (const auto& pair : some.pairs) {
            result.involution.mean_percent += left_over(pair) / 10;
            result.involution.max_percent =
                std::max(result.involution.max_percent, left_over(pair));
        }
        for (const auto& pair : asked.pairs) result.distance_percent.push_back(left_over(pair));
        result.distance_percent.push_back(0);
        return result;
    }

    std::optional<LandmarkDoubt> doubt(const SphereLandmarks& asked) const {
        return find_wrong_landmarks(
            asked, distances, trial(asked, asked).involution,
            [&](const SphereLandmarks& some) { return trial(some, asked); });
    }

    SphereLandmarks good;
    std::vector<double> place;
    SurfaceDistances distances;
};

TEST_F(WrongLandmarks, AreNotFoundAmongGoodOnes) { EXPECT_FALSE(doubt(good).has_value()); }

TEST_F(WrongLandmarks, AreFoundByLeavingOneOut) {
    for (std::size_t p = 0; p < good.pairs.size(); ++p) {
        SphereLandmarks landmarks = good;
        landmarks.pairs[p][1] = 2 * static_cast<int>((p + 2) % good.pairs.size()) + 1;
        const std::optional<LandmarkDoubt> found = doubt(landmarks);
        ASSERT_TRUE(found.has_value());
        EXPECT_TRUE(found->is_certain);
        EXPECT_FALSE(found->is_exchange);
        EXPECT_EQ(found->landmarks, std::vector<std::size_t>{p});
    }
}

TEST_F(WrongLandmarks, AreFoundByExchangingTwo) {
    for (std::size_t p = 0; p + 1 < good.pairs.size(); ++p) {
        SphereLandmarks landmarks = good;
        std::swap(landmarks.pairs[p][1], landmarks.pairs[p + 1][1]);
        // Either end may come first in a pair.
        std::swap(landmarks.pairs[p][0], landmarks.pairs[p][1]);
        const std::optional<LandmarkDoubt> found = doubt(landmarks);
        ASSERT_TRUE(found.has_value());
        EXPECT_TRUE(found->is_certain);
        EXPECT_TRUE(found->is_exchange);
        EXPECT_EQ(found->landmarks, (std::vector<std::size_t>{p, p + 1}));
    }
}

TEST_F(WrongLandmarks, AreAGuessWhereNoneMendsTheMap) {
    SphereLandmarks landmarks = good;
    landmarks.pairs[0][1] = 5;
    landmarks.pairs[3][1] = 1;
    landmarks.pairs[4][1] = 3;
    landmarks.pairs[1][1] = 9;
    const std::optional<LandmarkDoubt> found = doubt(landmarks);
    ASSERT_TRUE(found.has_value());
    EXPECT_FALSE(found->is_certain);
    // The farthest off: -40 to 10, -20 to 50 and -50 to 20.
    EXPECT_TRUE(found->landmarks == std::vector<std::size_t>{1} ||
                found->landmarks == std::vector<std::size_t>{3} ||
                found->landmarks == std::vector<std::size_t>{4});
}

}  // namespace
}  // namespace kinequad
