#include "input_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "kinequad/core/error.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/pipeline/options.h"

namespace kinequad::app {

void InputOptions::add_options(CLI::App& command) {
    command
        .add_option(
            "--cache-up", cache_up_,
            "Axis that points up in a PC2 or MDD cache, where it differs from the OBJ beside it: "
            "mesh (as there), y or z")
        ->check(CLI::IsMember({"mesh", "y", "z"}))
        ->capture_default_str();
}

std::unique_ptr<FrameSource> InputOptions::open(const std::string& input) const {
    SequenceOptions options;
    if (cache_up_ == "y") options.cache_up = CacheUp::y;
    if (cache_up_ == "z") options.cache_up = CacheUp::z;
    return open_sequence(input, options);
}

int parse_reference(const std::string& text, const FrameSource& source) {
    if (text == "rest") {
        require(source.has_rest_shape(), InputFault::usage,
                "--reference rest: the input has no rest shape; name a frame");
        return Options::rest_shape;
    }
    int frame = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
    if (error != std::errc() || end != text.data() + text.size() || frame < 0 ||
        frame >= source.frame_count()) {
        throw InputError(InputFault::usage,
                         fmt::format("--reference {}: has to be a frame from 0 to {}, or rest",
                                     text, source.frame_count() - 1));
    }
    return frame;
}

Positions read_reference(const FrameSource& source, int reference) {
    return reference == Options::rest_shape ? source.read_rest_shape()
                                            : source.read_frame(reference);
}

}  // namespace kinequad::app
