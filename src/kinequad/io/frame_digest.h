#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "kinequad/io/frame_source.h"

namespace kinequad {

/// A 64-bit fingerprint of a sequence, gathered frame by frame as they are read: the same for the
/// same faces and the same doubles in the same frames, whatever the file format, the order of the
/// calls, the threads or the machine. It tells two inputs apart by accident, not against an
/// adversary.
class FrameDigest {
public:
    /// Begins with the faces that all frames share.
    explicit FrameDigest(const Polygons& faces);
    /// Adds frame `frame` with positions `V` (n x 3). Once a frame; safe to call from several
    /// threads.
    void add(int frame, const Positions& V);
    /// The fingerprint of what was added so far.
    std::uint64_t value() const { return sum_.load(); }
    /// `value()` as 16 hexadecimal digits.
    std::string text() const;

private:
    std::atomic<std::uint64_t> sum_;
};

/// The fingerprint of a whole sequence, as 16 hexadecimal digits; reads every frame (not the rest
/// shape).
std::string compute_digest(const FrameSource& source);

}  // namespace kinequad
