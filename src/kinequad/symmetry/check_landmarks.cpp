#include "kinequad/symmetry/check_landmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

/// A landmark as a pair; a stationary vertex is its own partner.
using Mark = std::array<int, 2>;

/// By how much landmark `i` is asymmetric as seen from landmark `j`.
double disagreement(const SurfaceDistances& distances, const Mark& i, const Mark& j) {
    const auto from = [&](int source, int vertex) {
        const auto found = std::find(distances.source.begin(), distances.source.end(), source);
        const auto row = static_cast<std::size_t>(found - distances.source.begin());
        return distances.distance[row][static_cast<std::size_t>(vertex)];
    };
    const double straight = std::abs(from(i[0], j[0]) - from(i[1], j[1]));
    const double crossed = std::abs(from(i[0], j[1]) - from(i[1], j[0]));
    return std::max(straight, crossed);
}

/// The value below which `share` of the values lie; 0 where there are none.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

void check_landmarks(const Landmarks& landmarks, int vertex_count) {
    std::set<int> seen;
    const auto check = [&](int vertex) {
        if (vertex < 0 || vertex >= vertex_count) {
            throw InputError(InputFault::symmetry,
                             fmt::format("landmarks: name vertex {}, but the mesh has {} vertices, "
                                         "counted from 0",
                                         vertex, vertex_count));
        }
        if (!seen.insert(vertex).second) {
            throw InputError(InputFault::symmetry,
                             fmt::format("landmarks: vertex {} is named twice; name it in one pair "
                                         "or once as stationary",
                                         vertex));
        }
    };
    for (const auto& [a, b] : landmarks.pairs) {
        check(a);
        check(b);
    }
    for (const int vertex : landmarks.stationary) check(vertex);
    if (2 * landmarks.pairs.size() + landmarks.stationary.size() < 3) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("landmarks: {} pairs and {} stationary vertices leave more than one "
                        "symmetry; give at least two pairs, or one pair and a stationary vertex",
                        landmarks.pairs.size(), landmarks.stationary.size()));
    }
}

double compare_landmark_distances(const SurfaceDistances& distances, const SphereLandmarks& marks,
                                  const Landmarks& names, double tolerated_percent) {
    std::vector<Mark> all(marks.pairs.begin(), marks.pairs.end());
    for (const int v : marks.stationary) all.push_back({v, v});
    std::vector<double> typical(all.size(), 0.0);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<double> seen;
        for (std::size_t j = 0; j < all.size(); ++j) {
            // Two stationary vertices agree whatever they are.
            const bool both_stationary = all[i][0] == all[i][1] && all[j][0] == all[j][1];
            if (i == j || both_stationary) continue;
            seen.push_back(100 * disagreement(distances, all[i], all[j]) / distances.extent);
            sum += seen.back();
            ++count;
        }
        // Not the largest, which one wrong partner spoils for all, and not the median: from most
        // limbs the two sides of another limb are almost equally far.
        typical[i] = quantile(seen, 0.75);
    }
    const auto worst = static_cast<std::size_t>(std::max_element(typical.begin(), typical.end()) -
                                                typical.begin());
    const double worst_percent = typical[worst];
    // Where most agree well, less is enough to stand out.
    const double outlying = std::max(5.0, 5 * quantile(typical, 0.5));
    if (worst_percent > std::min(tolerated_percent, outlying)) {
        const bool is_pair = worst < names.pairs.size();
        const std::string what =
            is_pair
                ? fmt::format("pair {} ({}, {})", worst, names.pairs[worst][0],
                              names.pairs[worst][1])
                : fmt::format("stationary vertex {}", names.stationary[worst - names.pairs.size()]);
        throw InputError(InputFault::symmetry,
                         fmt::format("landmarks: {} disagrees with the others: distances to them "
                                     "differ by {:.0f} % of the surface's extent between the two "
                                     "sides; pick it again",
                                     what, worst_percent));
    }
    return count > 0 ? sum / count : 0;
}

}  // namespace kinequad
