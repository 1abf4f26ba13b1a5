#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/io/landmarks.h"

namespace kinequad {

struct SynthOptions {
    int triangle_count = 20000;  ///< met within ten per cent; 1,000 to 4,000,000
    int frame_count = 48;        ///< of one cycle of the motion, at least 1
};

/// An example creature in motion whose symmetry is known: a closed surface of genus 0 in metres, y
/// up, facing +z. At rest it is its own mirror image in x = 0, bit for bit; in no frame of the
/// motion is it symmetric. Frames are computed when asked for; the last one leads over into the
/// first.
class SyntheticCreature : public FrameSource {
public:
    /// Mirror vertex of every vertex (n), an involution that maps triangles to reversed triangles.
    virtual const std::vector<int>& mirror() const = 0;
    /// Vertices that a user would pick: tips of limbs, joints, nose, crown. No vertex occurs twice.
    virtual const Landmarks& landmarks() const = 0;
};

/// Names that `synthesize_creature` knows.
std::vector<std::string> list_creatures();

/// Makes the creature called `name` [docs/synth.md]. Throws `InputError` (usage) for an unknown
/// name or a size out of range. The result does not depend on the number of threads.
std::unique_ptr<SyntheticCreature> synthesize_creature(std::string_view name,
                                                       const SynthOptions& options,
                                                       const Context& context);

}  // namespace kinequad
