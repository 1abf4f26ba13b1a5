#pragma once

#include <memory>
#include <string>

#include "kinequad/core/types.h"
#include "kinequad/io/frame_source.h"

namespace CLI {
class App;
}

namespace kinequad::app {

/// How the input of a command is understood: the options that commands with an animated input
/// share.
class InputOptions {
public:
    /// Adds --cache-up.
    void add_options(CLI::App& command);
    /// Opens the sequence `input`. Throws as `open_sequence`.
    std::unique_ptr<FrameSource> open(const std::string& input) const;

private:
    std::string cache_up_ = "mesh";
};

/// What a --reference option says: a frame, or `Options::rest_shape` for "rest". Throws
/// `InputError` (usage) for anything else and where `source` has no such frame.
int parse_reference(const std::string& text, const FrameSource& source);

/// Positions (n x 3) of frame `reference` or of the rest shape.
Positions read_reference(const FrameSource& source, int reference);

}  // namespace kinequad::app
