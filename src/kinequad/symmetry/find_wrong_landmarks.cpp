#include "kinequad/symmetry/find_wrong_landmarks.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// The pair that has a vertex closest to one of pair `i`; `i` itself where there is no other.
std::size_t nearest_pair(const SphereLandmarks& marks, const SurfaceDistances& distances,
                         std::size_t i) {
    std::size_t nearest = i;
    double least = std::numeric_limits<double>::infinity();
    for (const int from : marks.pairs[i]) {
        const auto source = std::find(distances.source.begin(), distances.source.end(), from);
        if (source == distances.source.end()) continue;
        const std::vector<double>& distance =
            distances.distance[at(source - distances.source.begin())];
        for (std::size_t j = 0; j < marks.pairs.size(); ++j) {
            for (const int to : marks.pairs[j]) {
                if (j == i || distance[at(to)] >= least) continue;
                least = distance[at(to)];
                nearest = j;
            }
        }
    }
    return nearest;
}

/// The landmarks without number `i`, pairs first.
SphereLandmarks without(SphereLandmarks landmarks, std::size_t i) {
    const std::size_t pairs = landmarks.pairs.size();
    if (i < pairs) {
        landmarks.pairs.erase(landmarks.pairs.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
        landmarks.stationary.erase(landmarks.stationary.begin() +
                                   static_cast<std::ptrdiff_t>(i - pairs));
    }
    return landmarks;
}

}  // namespace

std::optional<LandmarkDoubt> find_wrong_landmarks(const SphereLandmarks& marks,
                                                  const SurfaceDistances& distances,
                                                  const InvolutionError& with_all,
                                                  const LandmarkTrials& try_landmarks) {
    constexpr double better_share = 0.6;
    constexpr double least_distance_percent = 2;
    std::optional<LandmarkDoubt> best;
    const auto is_better = [](const LandmarkDoubt& a, const LandmarkDoubt& b) {
        if (a.is_certain != b.is_certain) return a.is_certain;
        // What makes a far better map is known by that, the rest by how far it is off.
        return a.is_certain ? a.involution.mean_percent < b.involution.mean_percent
                            : a.distance_percent > b.distance_percent;
    };
    const auto consider = [&](const std::vector<std::size_t>& landmarks,
                              const SphereLandmarks& others, bool is_exchange) {
        const std::optional<LandmarkTrial> trial = try_landmarks(others);
        if (!trial || trial->involution.mean_percent >= with_all.mean_percent) return;
        LandmarkDoubt doubt{landmarks, std::numeric_limits<double>::infinity(), trial->involution,
                            is_exchange};
        for (const std::size_t i : landmarks) {
            doubt.distance_percent = std::min(doubt.distance_percent, trial->distance_percent[i]);
        }
        doubt.is_certain = !is_doubtful(trial->involution) &&
                           trial->involution.mean_percent < better_share * with_all.mean_percent &&
                           doubt.distance_percent > least_distance_percent;
        if (!best || is_better(doubt, *best)) best = std::move(doubt);
    };
    for (std::size_t i = 0; i < marks.pairs.size() + marks.stationary.size(); ++i) {
        consider({i}, without(marks, i), false);
    }
    for (std::size_t i = 0; i < marks.pairs.size(); ++i) {
        const std::size_t j = nearest_pair(marks, distances, i);
        const bool is_done = j < i && nearest_pair(marks, distances, j) == i;
        if (j == i || is_done) continue;
        for (const std::size_t end : {0U, 1U}) {
            SphereLandmarks exchanged = marks;
            std::swap(exchanged.pairs[i][1], exchanged.pairs[j][end]);
            consider({std::min(i, j), std::max(i, j)}, exchanged, true);
        }
    }
    return best;
}

}  // namespace kinequad
