#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Receives an animated mesh one frame at a time. Nothing is at its place before `finish()`: a sink
/// destroyed without it leaves the folder as it was.
class FrameSink {
public:
    FrameSink(int frame_count, int vertex_count)
        : frame_count_(frame_count), vertex_count_(vertex_count) {}
    FrameSink(const FrameSink&) = delete;
    FrameSink& operator=(const FrameSink&) = delete;
    virtual ~FrameSink() = default;

    /// Takes the n x 3 positions of frame `frame`; frames come in order from 0. Throws `InputError`
    /// (file) where the disk refuses, (mesh) where a position cannot be stored, `std::logic_error`
    /// where order or size are wrong.
    void write_frame(int frame, const Positions& V);
    /// Gives all files their names. Throws `InputError` (file) where the disk refuses,
    /// `std::logic_error` where frames are missing.
    void finish();
    /// The files that are there after `finish()`.
    virtual std::vector<std::filesystem::path> files() const = 0;

protected:
    int frame_count() const { return frame_count_; }

private:
    virtual void append(int frame, const Positions& V) = 0;
    virtual void commit() = 0;

    int frame_count_;
    int vertex_count_;
    int written_ = 0;
};

/// File formats that hold an animated mesh.
enum class SequenceFormat {
    obj,  ///< STEM_0000.obj, STEM_0001.obj, ...; doubles read back exactly
    ply,  ///< STEM_0000.ply, ... binary little endian; doubles read back exactly
    pc2,  ///< STEM.obj with the rest shape and STEM.pc2; 32-bit floats
    mdd,  ///< STEM.obj with the rest shape and STEM.mdd; 32-bit floats, 24 frames a second
};

/// The format that the command line calls `name` ("obj", "ply", "pc2", "mdd"), if any.
std::optional<SequenceFormat> find_sequence_format(std::string_view name);

/// Begins a sequence of `frame_count` frames in `directory`, which is made where it is missing.
/// `faces` are those of every frame, `rest` (n x 3) the shape that the OBJ beside a cache gets; the
/// frames have as many vertices. Throws `InputError` (file) where the folder cannot be written, or
/// where numbered frames of an earlier, longer sequence would mix with this one.
std::unique_ptr<FrameSink> create_frame_sink(const std::filesystem::path& directory,
                                             const std::string& stem, SequenceFormat format,
                                             const Polygons& faces, int frame_count,
                                             const Positions& rest);

}  // namespace kinequad
