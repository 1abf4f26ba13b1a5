#include "kinequad/io/frame_digest.h"

#include <fmt/format.h>

#include <bit>

namespace kinequad {
namespace {

/// Word-wise multiplicative hash; the finisher is that of MurmurHash3 [Appleby 2011].
class WordHash {
public:
    explicit WordHash(std::uint64_t seed) : state_(seed ^ 0x9e3779b97f4a7c15U) {}
    void add(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x9fb21c651e98df25U;
        state_ ^= state_ >> 29U;
    }
    std::uint64_t value() const {
        std::uint64_t h = state_;
        h = (h ^ (h >> 33U)) * 0xff51afd7ed558ccdU;
        h = (h ^ (h >> 33U)) * 0xc4ceb9fe1a85ec53U;
        return h ^ (h >> 33U);
    }

private:
    std::uint64_t state_;
};

std::uint64_t hash_of(const Polygons& faces) {
    WordHash hash(static_cast<std::uint64_t>(faces.count()));
    for (int f = 0; f < faces.count(); ++f) {
        hash.add(faces[f].size());
        for (const int vertex : faces[f]) hash.add(static_cast<std::uint64_t>(vertex));
    }
    return hash.value();
}

}  // namespace

FrameDigest::FrameDigest(const Polygons& faces) : sum_(hash_of(faces)) {}

void FrameDigest::add(int frame, const Positions& V) {
    WordHash hash(static_cast<std::uint64_t>(frame));
    hash.add(static_cast<std::uint64_t>(V.rows()));
    for (Eigen::Index k = 0; k < V.size(); ++k) hash.add(std::bit_cast<std::uint64_t>(V.data()[k]));
    // A sum does not depend on the order in which threads bring the frames.
    sum_.fetch_add(hash.value());
}

std::string FrameDigest::text() const { return fmt::format("{:016x}", value()); }

std::string compute_digest(const FrameSource& source) {
    FrameDigest digest(source.polygons());
    for (int f = 0; f < source.frame_count(); ++f) digest.add(f, source.read_frame(f));
    return digest.text();
}

}  // namespace kinequad
