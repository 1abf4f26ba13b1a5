#include "kinequad/symmetry/check_landmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// A landmark as a pair; a stationary vertex is its own partner.
using Mark = std::array<int, 2>;

/// By how much landmark `i` is asymmetric as seen from landmark `j`.
double disagreement(const SurfaceDistances& distances, const Mark& i, const Mark& j) {
    const auto from = [&](int source, int vertex) {
        const auto found = std::find(distances.source.begin(), distances.source.end(), source);
        const auto row = static_cast<std::size_t>(found - distances.source.begin());
        return distances.distance[row][at(vertex)];
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

/// "X disagrees", or "X or Y disagrees" where what the landmarks differ by (`typical`, beyond
/// `tolerated`) does not tell which of them it is, as where there are only a few.
std::string describe_suspects(const Landmarks& names, const std::vector<double>& typical,
                              double tolerated) {
    constexpr double alike = 0.85;
    constexpr std::size_t most_named = 3;
    constexpr std::size_t few = 3;
    std::vector<std::size_t> order(typical.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return typical[a] > typical[b]; });
    std::vector<std::string> suspects;
    for (const std::size_t i : order) {
        const bool is_suspect = typical.size() <= few ? typical[i] > tolerated
                                                      : typical[i] >= alike * typical[order[0]];
        if (is_suspect && suspects.size() < most_named) {
            suspects.push_back(describe_landmark(names, i));
        }
    }
    return fmt::format("{} disagrees", fmt::join(suspects, " or "));
}

}  // namespace

std::string describe_landmark(const Landmarks& landmarks, std::size_t i) {
    if (i < landmarks.pairs.size()) {
        const auto& [a, b] = landmarks.pairs[i];
        return fmt::format("pairs[{}] ({}, {})", i, a, b);
    }
    const std::size_t s = i - landmarks.pairs.size();
    return fmt::format("stationary[{}] ({})", s, landmarks.stationary[s]);
}

void check_landmarks(const Landmarks& landmarks, const Topology& topology) {
    require_landmarks_fit(landmarks, topology.vertex_count);
    require_named_once(landmarks);
    const std::size_t pairs = landmarks.pairs.size();
    const std::size_t stationary = landmarks.stationary.size();
    const auto require_used = [&](int vertex, std::size_t landmark) {
        if (topology.vertex_half_edge[at(vertex)] >= 0) return;
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: vertex {} of {} belongs to no triangle; pick a vertex of "
                        "the surface",
                        landmarks.name, vertex, describe_landmark(landmarks, landmark)));
    };
    for (std::size_t p = 0; p < pairs; ++p) {
        for (const int vertex : landmarks.pairs[p]) require_used(vertex, p);
    }
    for (std::size_t s = 0; s < stationary; ++s) {
        require_used(landmarks.stationary[s], pairs + s);
    }
    if (2 * pairs + stationary < 3) {
        throw InputError(
            InputFault::symmetry,
            fmt::format(
                "{}: {} {} and {} stationary {} leave more than one symmetry; give at least "
                "two pairs, a pair and a stationary vertex, or three stationary vertices",
                landmarks.name, pairs, pairs == 1 ? "pair" : "pairs", stationary,
                stationary == 1 ? "vertex" : "vertices"));
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
    const double worst_percent = *std::max_element(typical.begin(), typical.end());
    // Where most agree well, less is enough to stand out.
    const double outlying = std::max(5.0, 5 * quantile(typical, 0.5));
    const double tolerated = std::min(tolerated_percent, outlying);
    if (worst_percent > tolerated) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: {} with the others: distances to them differ by {:.0f} % "
                        "of the surface's extent between the two sides; pick it again",
                        names.name, describe_suspects(names, typical, tolerated), worst_percent));
    }
    return count > 0 ? sum / count : 0;
}

void warn_of_turned_pairs(const Landmarks& landmarks, const Eigen::VectorXd& height,
                          const Context& context) {
    constexpr std::size_t least_agreeing = 3;
    std::vector<std::size_t> upward;
    std::vector<std::size_t> downward;
    for (std::size_t p = 0; p < landmarks.pairs.size(); ++p) {
        (height[landmarks.pairs[p][0]] > 0 ? upward : downward).push_back(p);
    }
    const auto& [few, many] =
        upward.size() < downward.size() ? std::tie(upward, downward) : std::tie(downward, upward);
    // Who never minded the order gets no warning.
    if (many.size() < least_agreeing || few.size() * least_agreeing > many.size()) return;
    for (const std::size_t p : few) {
        context.write_log(LogLevel::warning,
                          fmt::format("{}: {} names left and right in the opposite order to most "
                                      "pairs; the map is the same either way",
                                      landmarks.name, describe_landmark(landmarks, p)));
    }
}

}  // namespace kinequad
