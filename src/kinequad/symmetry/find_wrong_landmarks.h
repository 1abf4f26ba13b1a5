#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/surface_distances.h"
#include "kinequad/symmetry/verify_symmetry_map.h"

namespace kinequad {

/// A map made of some landmarks alone.
struct LandmarkTrial {
    InvolutionError involution;
    /// For every landmark, pairs first, used or not: how far the map sends it from its partner, in
    /// percent of the bounding-box diagonal.
    std::vector<double> distance_percent;
};

/// What is found of landmarks by leaving some out.
struct LandmarkDoubt {
    std::vector<std::size_t> landmarks;  ///< numbers of the doubtful ones, pairs first
    double distance_percent = 0;  ///< how far the map without them sends one from its partner
    InvolutionError involution;   ///< of the map without them
    bool is_exchange = false;     ///< the partners of two pairs, exchanged, make the map
    bool is_certain = false;      ///< that map is far better, and sends them far away
};

/// Makes the map of some landmarks; nothing where there is none.
using LandmarkTrials = std::function<std::optional<LandmarkTrial>(const SphereLandmarks& some)>;

/// Looks for the landmarks that spoil a map: leaves out each in turn, then exchanges the partners
/// of each pair and the pair nearest to it. `with_all` is how far from an involution the map of all
/// landmarks, `marks`, is. `distances` are those of at least `marks`. Empty where there is no other
/// map. docs/symmetry.md
std::optional<LandmarkDoubt> find_wrong_landmarks(const SphereLandmarks& marks,
                                                  const SurfaceDistances& distances,
                                                  const InvolutionError& with_all,
                                                  const LandmarkTrials& try_landmarks);

}  // namespace kinequad
