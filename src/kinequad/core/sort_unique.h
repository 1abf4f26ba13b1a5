#pragma once

#include <algorithm>
#include <vector>

namespace kinequad {

/// Puts `list` in ascending order and keeps one of equal elements.
template <class Element>
void sort_unique(std::vector<Element>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace kinequad
