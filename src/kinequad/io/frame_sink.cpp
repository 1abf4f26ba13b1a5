#include "kinequad/io/frame_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "kinequad/core/error.h"
#include "kinequad/io/byte_order.h"
#include "kinequad/io/encode_mesh.h"
#include "kinequad/io/pending_files.h"

namespace kinequad {
namespace {

constexpr float frames_per_second = 24;

std::string frame_name(const std::string& stem, int frame, int frame_count,
                       const std::string& extension) {
    const std::size_t digits = std::max<std::size_t>(4, std::to_string(frame_count - 1).size());
    return fmt::format("{}_{:0{}}{}", stem, frame, digits, extension);
}

/// A reader takes every frame in the folder: those left by a longer sequence would be taken for
/// ours.
void require_no_older_frames(const std::filesystem::path& directory, const std::string& stem,
                             int frame_count, const std::string& extension) {
    std::vector<std::string> ours;
    ours.reserve(static_cast<std::size_t>(frame_count));
    for (int f = 0; f < frame_count; ++f)
        ours.push_back(frame_name(stem, f, frame_count, extension));
    std::sort(ours.begin(), ours.end());
    std::error_code reason;
    std::filesystem::directory_iterator entry(directory.empty() ? "." : directory, reason);
    for (; !reason && entry != std::filesystem::directory_iterator(); entry.increment(reason)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(stem + "_") || !name.ends_with(extension)) continue;
        const std::size_t begin = stem.size() + 1;
        if (name.size() <= begin + extension.size()) continue;
        const std::string number = name.substr(begin, name.size() - begin - extension.size());
        if (number.find_first_not_of("0123456789") != std::string::npos) continue;
        if (std::binary_search(ours.begin(), ours.end(), name)) continue;
        throw InputError(
            InputFault::file,
            fmt::format("{}: is a frame of an earlier sequence, which a reader would take "
                        "for a part of the new one; remove it or name another folder",
                        entry->path().string()));
    }
}

/// One file a frame: what comes before the positions, the positions, what comes behind them.
class NumberedFiles : public FrameSink {
public:
    NumberedFiles(const std::filesystem::path& directory, std::string stem, SequenceFormat format,
                  const Polygons& faces, int frame_count, int vertex_count)
        : FrameSink(frame_count, vertex_count),
          stem_(std::move(stem)),
          is_ply_(format == SequenceFormat::ply),
          files_(directory) {
        require_no_older_frames(directory, stem_, frame_count, extension());
        if (is_ply_) head_ = encode_ply_header(vertex_count, faces);
        tail_ = is_ply_ ? encode_ply_faces(faces) : encode_obj_faces(faces);
    }
    std::vector<std::filesystem::path> files() const override { return files_.paths(); }

private:
    std::string extension() const { return is_ply_ ? ".ply" : ".obj"; }
    void append(int frame, const Positions& V) override {
        files_.open(frame_name(stem_, frame, frame_count(), extension()));
        files_.write(head_ + (is_ply_ ? encode_ply_positions(V) : encode_obj_positions(V)));
        files_.write(tail_);
    }
    void commit() override { files_.commit(); }

    std::string stem_;
    bool is_ply_;
    PendingFiles files_;
    std::string head_;
    std::string tail_;
};

std::string encode_pc2_head(int vertex_count, int frame_count) {
    std::string head("POINTCACHE2\0", 12);
    head.resize(32);
    store_number(head.data() + 12, std::int32_t{1}, std::endian::little);
    store_number(head.data() + 16, std::int32_t{vertex_count}, std::endian::little);
    store_number(head.data() + 20, float{0}, std::endian::little);
    store_number(head.data() + 24, float{1}, std::endian::little);
    store_number(head.data() + 28, std::int32_t{frame_count}, std::endian::little);
    return head;
}

std::string encode_mdd_head(int vertex_count, int frame_count) {
    std::string head(8 + 4 * static_cast<std::size_t>(frame_count), '\0');
    store_number(head.data(), std::int32_t{frame_count}, std::endian::big);
    store_number(head.data() + 4, std::int32_t{vertex_count}, std::endian::big);
    for (int f = 0; f < frame_count; ++f) {
        store_number(head.data() + 8 + 4 * static_cast<std::size_t>(f),
                     static_cast<float>(f) / frames_per_second, std::endian::big);
    }
    return head;
}

/// An OBJ with the rest shape and a cache with all frames.
class PointCacheFiles : public FrameSink {
public:
    PointCacheFiles(const std::filesystem::path& directory, const std::string& stem,
                    SequenceFormat format, const Polygons& faces, int frame_count,
                    const Positions& rest)
        : FrameSink(frame_count, static_cast<int>(rest.rows())),
          order_(format == SequenceFormat::mdd ? std::endian::big : std::endian::little),
          files_(directory) {
        const auto vertex_count = static_cast<int>(rest.rows());
        files_.open(stem + ".obj");
        files_.write(encode_obj_positions(rest) + encode_obj_faces(faces));
        if (format == SequenceFormat::mdd) {
            files_.open(stem + ".mdd");
            files_.write(encode_mdd_head(vertex_count, frame_count));
        } else {
            files_.open(stem + ".pc2");
            files_.write(encode_pc2_head(vertex_count, frame_count));
        }
    }
    std::vector<std::filesystem::path> files() const override { return files_.paths(); }

private:
    void append(int frame, const Positions& V) override {
        if (V.size() > 0 && V.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max()) {
            throw InputError(
                InputFault::mesh,
                fmt::format("frame {} has coordinates too large for the 32-bit floats of a "
                            "point cache; write OBJ or PLY",
                            frame));
        }
        bytes_.resize(static_cast<std::size_t>(V.size()) * sizeof(float));
        for (Eigen::Index k = 0; k < V.size(); ++k) {
            store_number(bytes_.data() + static_cast<std::size_t>(k) * sizeof(float),
                         static_cast<float>(V.data()[k]), order_);
        }
        files_.write(bytes_);
    }
    void commit() override { files_.commit(); }

    std::endian order_;
    PendingFiles files_;
    std::string bytes_;
};

}  // namespace

void FrameSink::write_frame(int frame, const Positions& V) {
    if (frame != written_ || frame >= frame_count_) {
        throw std::logic_error("frames have to be written in order, each once");
    }
    if (V.rows() != vertex_count_) {
        throw std::logic_error("a frame has another number of vertices than the sequence");
    }
    if (!V.allFinite()) {
        throw InputError(
            InputFault::mesh,
            fmt::format("frame {} has a position that is not finite and is not written", frame));
    }
    append(frame, V);
    ++written_;
}

void FrameSink::finish() {
    if (written_ != frame_count_)
        throw std::logic_error("frames are missing at the end of a sequence");
    commit();
}

std::optional<SequenceFormat> find_sequence_format(std::string_view name) {
    if (name == "obj") return SequenceFormat::obj;
    if (name == "ply") return SequenceFormat::ply;
    if (name == "pc2") return SequenceFormat::pc2;
    if (name == "mdd") return SequenceFormat::mdd;
    return std::nullopt;
}

std::unique_ptr<FrameSink> create_frame_sink(const std::filesystem::path& directory,
                                             const std::string& stem, SequenceFormat format,
                                             const Polygons& faces, int frame_count,
                                             const Positions& rest) {
    if (frame_count < 1) throw std::logic_error("a sequence has at least one frame");
    if (format == SequenceFormat::obj || format == SequenceFormat::ply) {
        return std::make_unique<NumberedFiles>(directory, stem, format, faces, frame_count,
                                               static_cast<int>(rest.rows()));
    }
    return std::make_unique<PointCacheFiles>(directory, stem, format, faces, frame_count, rest);
}

}  // namespace kinequad
