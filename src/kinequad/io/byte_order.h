#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

namespace kinequad {

/// The number of type `T` stored at `bytes` in the byte order `order`.
template <class T>
T load_number(const char* bytes, std::endian order) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (order != std::endian::native) {
        for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(raw[k], raw[sizeof(T) - 1 - k]);
    }
    return std::bit_cast<T>(raw);
}

/// Stores `value` at `bytes` in the byte order `order`.
template <class T>
void store_number(char* bytes, T value, std::endian order) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) {
        for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(raw[k], raw[sizeof(T) - 1 - k]);
    }
    std::memcpy(bytes, raw.data(), sizeof(T));
}

}  // namespace kinequad
