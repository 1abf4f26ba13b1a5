#pragma once

#include <concepts>
#include <cstddef>

namespace kinequad {

/// Index of an element of a standard container where ours is signed, as Eigen's are: not negative.
constexpr std::size_t at(std::signed_integral auto i) { return static_cast<std::size_t>(i); }

}  // namespace kinequad
